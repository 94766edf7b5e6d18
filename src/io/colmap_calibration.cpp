#include <algorithm>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/core/quaternion.hpp>
#include <optional>

#include "io/calibration_formats.hpp"
#include "io/rig_camera.hpp"
#include "io/rigid_transform.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

using Words = std::vector<std::string_view>;

/// Parameters of a model: focal lengths, cx, cy, coefficients in OpenCV's order, of which the last ones may be left
/// out.
struct ColmapModel {
  std::string_view name;
  std::size_t focals;
  std::size_t coefficients;
  bool fisheye;
};
constexpr std::array<ColmapModel, 9> models{{{"SIMPLE_PINHOLE", 1, 0, false},
                                             {"PINHOLE", 2, 0, false},
                                             {"SIMPLE_RADIAL", 1, 1, false},
                                             {"RADIAL", 1, 2, false},
                                             {"OPENCV", 2, 4, false},
                                             {"FULL_OPENCV", 2, 8, false},
                                             {"SIMPLE_RADIAL_FISHEYE", 1, 1, true},
                                             {"RADIAL_FISHEYE", 1, 2, true},
                                             {"OPENCV_FISHEYE", 2, 4, true}}};

/// Two cameras by their ids.
struct ColmapPair {
  std::string first, second;
  cv::Matx44d first_to_second;
};

/// Lines without comments; empty ones are kept, since an image without points has one.
std::vector<std::string_view> data_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (text.front() != '#') lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

RigCamera read_camera(const CalibrationText& file, const Words& words) {
  const std::string name(words[1]);
  const auto* const model =
      std::find_if(models.begin(), models.end(), [&](const ColmapModel& one) { return one.name == name; });
  if (model == models.end()) fail(file.path, ": the camera model ", name, " is not supported");
  const std::size_t parameters = model->focals + 2 + model->coefficients;
  if (words.size() != 4 + parameters) {
    fail(file.path, ": camera ", words[0], " has ", words.size() - 4, " parameters; ", name, " has ", parameters);
  }
  std::vector<double> values;
  for (std::size_t i = 4; i < words.size(); ++i) {
    values.push_back(parse_number(file.path, "a parameter of camera " + std::string(words[0]), words[i]));
  }
  // The centre of the first pixel is (0.5, 0.5) in COLMAP and (0, 0) in OpenCV.
  constexpr double shift = 0.5;
  const std::size_t centre = model->focals;
  RigCamera camera;
  camera.matrix = camera_matrix(values[0], values[centre - 1], values[centre] - shift, values[centre + 1] - shift);
  camera.distortion.assign(values.begin() + static_cast<std::ptrdiff_t>(centre) + 2, values.end());
  if (!camera.distortion.empty()) camera.distortion.resize(std::max<std::size_t>(4, camera.distortion.size()));
  camera.fisheye = model->fisheye;
  camera.width = parse_side(file.path, "WIDTH", words[2]);
  camera.height = parse_side(file.path, "HEIGHT", words[3]);
  return camera;
}

RigCamera find_camera(const CalibrationText& file, const std::string& id) {
  for (const std::string_view line : data_lines(file.text)) {
    const Words words = split_words(line);
    if (words.size() >= 4 && words[0] == id) return read_camera(file, words);
  }
  fail(file.path, ": there is no camera ", id);
}

/// QW, QX, QY, QZ, TX, TY, TZ.
cv::Matx44d read_pose(const CalibrationText& file, const Words& words, std::size_t at) {
  if (words.size() < at + 7) fail(file.path, ": a pose has less than seven numbers");
  std::array<double, 7> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = parse_number(file.path, "a pose", words[at + i]);
  const cv::Matx33d r = cv::Quatd(values[0], values[1], values[2], values[3]).toRotMat3x3();
  return {r(0, 0), r(0, 1), r(0, 2), values[4], r(1, 0), r(1, 1), r(1, 2), values[5],
          r(2, 0), r(2, 1), r(2, 2), values[6], 0,       0,       0,       1};
}

/// RIG_ID, number of sensors, type and id of the reference, then type, id, 1 and pose of the other.
ColmapPair read_rig(const CalibrationText& file, const Words& words) {
  if (words.size() != 14 || words[1] != "2" || words[4] != "CAMERA" || words[6] != "1") {
    fail(file.path, ": rig ", words[0], " is not one of two cameras with a pose");
  }
  return {std::string(words[3]), std::string(words[5]), read_pose(file, words, 7)};
}

/// An image, and its camera's id.
struct ColmapImage {
  std::string name, camera;
  cv::Matx44d from_world;
};

/// Images by the last part of their names, in the order of their names.
std::map<std::string, std::map<std::string, ColmapImage>> read_images(const CalibrationText& file) {
  std::map<std::string, std::map<std::string, ColmapImage>> images;
  const std::vector<std::string_view> lines = data_lines(file.text);
  for (std::size_t i = 0; i < lines.size(); i += 2) {  // the other lines are points
    const Words words = split_words(lines[i]);
    if (words.empty()) continue;
    if (words.size() < 10) fail(file.path, ": a line of an image has ", words.size(), " words; it must have 10");
    const std::string name(words[9].data(), words.back().data() + words.back().size());  // it may have spaces
    images[name.substr(name.rfind('/') + 1)][name] = {name, std::string(words[8]), read_pose(file, words, 1)};
  }
  return images;
}

/// The mean pose of the images of one camera against those of the same names of the other.
ColmapPair mean_pair(const CalibrationText& file) {
  std::optional<ColmapPair> pair;
  cv::Matx44d sum;
  double count = 0;
  for (const auto& [name, views] : read_images(file)) {
    if (views.size() != 2) continue;
    const ColmapImage &first = views.begin()->second, &second = std::next(views.begin())->second;
    if (!pair) pair = ColmapPair{first.camera, second.camera, {}};
    if (first.camera != pair->first || second.camera != pair->second) {
      fail(file.path, ": ", first.name, " and ", second.name, " are not of the cameras ", pair->first, " and ",
           pair->second, " as the other pairs are");
    }
    sum += second.from_world * inverse(first.from_world);
    ++count;
  }
  if (!pair) fail(file.path, ": there are no two images of the same name in two folders");
  cv::Matx31d singular;
  cv::Matx33d u, vt;
  cv::SVD::compute(sum.get_minor<3, 3>(0, 0), singular, u, vt);
  const cv::Matx33d r = u * vt;  // the closest rotation
  const cv::Vec3d t = cv::Vec3d(sum(0, 3), sum(1, 3), sum(2, 3)) / count;
  pair->first_to_second = {r(0, 0), r(0, 1), r(0, 2), t[0], r(1, 0), r(1, 1), r(1, 2), t[1],
                           r(2, 0), r(2, 1), r(2, 2), t[2], 0,       0,       0,       1};
  return *pair;
}

ColmapPair read_pair(const CalibrationText& file) {
  std::optional<ColmapPair> pair;
  for (const std::string_view line : data_lines(file.text)) {
    const Words words = split_words(line);
    if (words.size() < 3 || words[2] != "CAMERA") continue;
    if (words[1] == "1") continue;  // a camera alone
    if (pair) fail(file.path, ": there are several rigs; there must be one");
    pair = read_rig(file, words);
  }
  return pair ? *pair : mean_pair(file);
}

}  // namespace

bool is_colmap_cameras(std::string_view text) {
  for (const std::string_view line : data_lines(text)) {
    const Words words = split_words(line);
    if (words.empty()) continue;
    return words.size() > 4 &&
           std::any_of(models.begin(), models.end(), [&](const ColmapModel& model) { return model.name == words[1]; });
  }
  return false;
}

CalibrationFile read_colmap(const CalibrationText& cameras, const CalibrationText& poses) {
  ColmapPair pair = read_pair(poses);
  if (pair.first_to_second(0, 3) > 0) {  // the second camera is the left one
    std::swap(pair.first, pair.second);
    pair.first_to_second = inverse(pair.first_to_second);
  }
  const std::string source = cameras.path + " and " + poses.path;
  return describe_rig(
      join_cameras(find_camera(cameras, pair.first), find_camera(cameras, pair.second), pair.first_to_second, source),
      "COLMAP", source);
}

}  // namespace roadstereo::io
