#include <algorithm>
#include <array>

#include "io/camera_info.hpp"
#include "io/yaml_text.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Names of one value: those of calibration tools, of messages of ROS 2, and of ROS 1.
using Names = std::array<const char*, 3>;

/// Returns the first name that the file has; the first one if it has none.
const char* present(const YAML::Node& root, const Names& names) {
  const auto found = std::find_if(names.begin(), names.end(), [&](const char* name) { return bool(root[name]); });
  return found == names.end() ? names.front() : *found;
}

template <int Columns>
cv::Matx<double, 3, Columns> read_matrix(const CalibrationText& file, const YAML::Node& root, const Names& names) {
  const std::string key = present(root, names);
  const YAML::Node node = root[key];
  const YAML::Node data = node && node.IsMap() ? node["data"] : node;
  const std::vector<double> values = yaml_numbers(file, data, key);
  constexpr auto count = static_cast<std::size_t>(3 * Columns);
  if (values.size() != count) fail(file.path, ": ", key, " has ", values.size(), " values; it must have ", count);
  return cv::Matx<double, 3, Columns>(values.data());
}

std::string distortion_model(const YAML::Node& root) {
  const YAML::Node node = root["distortion_model"];
  return node && node.IsScalar() ? node.Scalar() : "plumb_bob";
}

CameraInfo read_camera(const CalibrationText& file) {
  const YAML::Node root = load_yaml(file);
  CameraInfo camera;
  camera.source = file.path;
  camera.width = yaml_side(file, root, root["image_width"] ? "image_width" : "width");
  camera.height = yaml_side(file, root, root["image_height"] ? "image_height" : "height");
  camera.distortion_model = distortion_model(root);
  camera.k = read_matrix<3>(file, root, {"camera_matrix", "k", "K"});
  camera.r = read_matrix<3>(file, root, {"rectification_matrix", "r", "R"});
  camera.p = read_matrix<4>(file, root, {"projection_matrix", "p", "P"});
  const std::string key = present(root, {"distortion_coefficients", "d", "D"});
  const YAML::Node distortion = root[key];
  const YAML::Node data = distortion && distortion.IsMap() ? distortion["data"] : distortion;
  camera.d = yaml_numbers(file, data, key);
  return camera;
}

}  // namespace

CalibrationFile read_ros_camera_info(const CalibrationText& left_file, const CalibrationText& right_file) {
  return join_camera_infos(read_camera(left_file), read_camera(right_file));
}

}  // namespace roadstereo::io
