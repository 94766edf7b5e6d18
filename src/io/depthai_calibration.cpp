#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "io/calibration_formats.hpp"
#include "io/rig_camera.hpp"
#include "io/rigid_transform.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Reads values by their keys, with errors that name file and key.
class DepthAiReader {
 public:
  explicit DepthAiReader(const std::string& path) : path_(path) {}

  const std::string& path() const { return path_; }
  const nlohmann::json& at(const nlohmann::json& object, const char* key) const {
    const bool present = object.is_object() && object.contains(key);
    if (!present) fail(path_, ": ", key, " is missing");
    return object[key];
  }
  double number(const nlohmann::json& value, const char* key) const {
    if (!value.is_number()) fail(path_, ": ", key, " must be a number");
    return value.get<double>();
  }
  int socket(const nlohmann::json& object, const char* key) const {
    const nlohmann::json& value = at(object, key);
    if (!value.is_number_integer()) fail(path_, ": ", key, " must be the number of a camera socket");
    return static_cast<int>(value.get<std::int64_t>());
  }
  /// Numbers of a list, or of a list of lists row by row.
  std::vector<double> numbers(const nlohmann::json& object, const char* key) const {
    const nlohmann::json& list = at(object, key);
    if (!list.is_array()) fail(path_, ": ", key, " must be a list of numbers");
    std::vector<double> values;
    for (const nlohmann::json& item : list) {
      if (item.is_array()) {
        for (const nlohmann::json& value : item) values.push_back(number(value, key));
      } else {
        values.push_back(number(item, key));
      }
    }
    return values;
  }
  std::vector<double> matrix(const nlohmann::json& object, const char* key) const {
    std::vector<double> values = numbers(object, key);
    if (values.size() != 9) fail(path_, ": ", key, " has ", values.size(), " values; it must have 9");
    return values;
  }

 private:
  std::string path_;
};

/// The camera of a socket: cameraData is a list of pairs (socket, camera).
const nlohmann::json& camera_of(const DepthAiReader& reader, const nlohmann::json& root, int socket) {
  const nlohmann::json& cameras = reader.at(root, "cameraData");
  if (!cameras.is_array()) fail(reader.path(), ": cameraData must be a list");
  for (const nlohmann::json& pair : cameras) {
    if (pair.is_array() && pair.size() == 2 && pair[0] == socket) return pair[1];
  }
  fail(reader.path(), ": cameraData has no camera of socket ", socket);
}

RigCamera read_camera(const DepthAiReader& reader, const nlohmann::json& data) {
  RigCamera camera;
  const std::vector<double> k = reader.matrix(data, "intrinsicMatrix");
  std::copy(k.begin(), k.end(), camera.matrix.begin());
  camera.distortion = reader.numbers(data, "distortionCoeff");
  const double type = reader.number(reader.at(data, "cameraType"), "cameraType");
  if (type != 0 && type != 1)
    fail(reader.path(), ": cameraType is ", type, "; it must be 0, perspective, or 1, fisheye");
  camera.fisheye = type == 1;
  if (camera.fisheye && camera.distortion.size() > 4) camera.distortion.resize(4);
  const auto side = [&](const char* key) {
    return image_side(reader.path(), key, reader.number(reader.at(data, key), key));
  };
  camera.width = side("width");
  camera.height = side("height");
  return camera;
}

/// Transform from a camera to the one that its extrinsics name, metres.
cv::Matx44d read_extrinsics(const DepthAiReader& reader, const nlohmann::json& extrinsics) {
  constexpr double cm = 1e-2;
  const std::vector<double> r = reader.matrix(extrinsics, "rotationMatrix");
  const nlohmann::json& t = reader.at(extrinsics, "translation");
  const auto metres = [&](const char* key) { return cm * reader.number(reader.at(t, key), key); };
  return {r[0], r[1], r[2], metres("x"), r[3], r[4], r[5], metres("y"), r[6], r[7], r[8], metres("z"), 0, 0, 0, 1};
}

}  // namespace

CalibrationFile read_depthai(const CalibrationText& file) {
  const DepthAiReader reader(file.path);
  const nlohmann::json root = nlohmann::json::parse(file.text, nullptr, false);
  if (root.is_discarded()) fail(file.path, ": invalid JSON");
  const nlohmann::json& stereo = reader.at(root, "stereoRectificationData");
  const int left_socket = reader.socket(stereo, "leftCameraSocket");
  const int right_socket = reader.socket(stereo, "rightCameraSocket");
  const nlohmann::json& left = camera_of(reader, root, left_socket);
  const nlohmann::json& right = camera_of(reader, root, right_socket);
  const nlohmann::json& from_left = reader.at(left, "extrinsics");
  const nlohmann::json& from_right = reader.at(right, "extrinsics");
  cv::Matx44d left_to_right;
  if (reader.socket(from_left, "toCameraSocket") == right_socket) {
    left_to_right = read_extrinsics(reader, from_left);
  } else if (reader.socket(from_right, "toCameraSocket") == left_socket) {
    left_to_right = inverse(read_extrinsics(reader, from_right));
  } else {
    fail(file.path, ": there are no extrinsics between the cameras of the sockets ", left_socket, " and ",
         right_socket);
  }
  return describe_rig(join_cameras(read_camera(reader, left), read_camera(reader, right), left_to_right, file.path),
                      "DepthAI", file.path);
}

}  // namespace roadstereo::io
