#include "io/rig_camera.hpp"
#include "io/rigid_transform.hpp"
#include "io/yaml_text.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

std::string word(const CalibrationText& file, const YAML::Node& camera, const std::string& key) {
  const YAML::Node node = camera[key];
  if (!node || !node.IsScalar()) fail(file.path, ": ", key, " is missing");
  return node.Scalar();
}

/// Whether the lens model is the equidistant one.
bool read_fisheye(const CalibrationText& file, const YAML::Node& camera) {
  const std::string model = word(file, camera, "camera_model");
  if (model != "pinhole") fail(file.path, ": camera_model is ", model, "; it must be pinhole");
  const std::string distortion = word(file, camera, "distortion_model");
  if (distortion == "equidistant") return true;
  if (distortion == "radtan" || distortion == "radial-tangential" || distortion == "none") return false;
  fail(file.path, ": distortion_model is ", distortion, "; it must be radtan, radial-tangential, equidistant or none");
}

std::vector<double> numbers(const CalibrationText& file, const YAML::Node& camera, const std::string& key,
                            std::size_t count) {
  std::vector<double> values = yaml_numbers(file, camera[key], key);
  if (values.size() != count) fail(file.path, ": ", key, " has ", values.size(), " values; it must have ", count);
  return values;
}

/// The keys that Kalibr and EuRoC share; EuRoC spells the name of the distortion out.
RigCamera read_camera(const CalibrationText& file, const YAML::Node& camera, const std::string& distortion) {
  const std::vector<double> k = numbers(file, camera, "intrinsics", 4);
  const std::vector<double> size = numbers(file, camera, "resolution", 2);
  RigCamera result;
  result.matrix = camera_matrix(k[0], k[1], k[2], k[3]);
  result.fisheye = read_fisheye(file, camera);
  if (word(file, camera, "distortion_model") != "none") {
    result.distortion = yaml_numbers(file, camera[distortion], distortion);
  }
  result.width = image_side(file.path, "resolution[0]", size[0]);
  result.height = image_side(file.path, "resolution[1]", size[1]);
  return result;
}

YAML::Node require_camera(const CalibrationText& file, const YAML::Node& root, const std::string& name) {
  const YAML::Node camera = root[name];
  if (!camera || !camera.IsMap()) fail(file.path, ": ", name, " is missing; a camchain must have cam0 and cam1");
  return camera;
}

/// Four lists of four numbers.
cv::Matx44d read_nested_transform(const CalibrationText& file, const YAML::Node& camera, const std::string& key) {
  const YAML::Node rows = camera[key];
  if (!rows || !rows.IsSequence() || rows.size() != 4) fail(file.path, ": ", key, " must be a list of four rows");
  std::vector<double> values;
  for (const YAML::Node& row : rows) {
    const std::vector<double> part = yaml_numbers(file, row, key);
    values.insert(values.end(), part.begin(), part.end());
  }
  return rigid_transform(values, file.path, key);
}

/// Pose of an EuRoC sensor in the body, T_BS.
cv::Matx44d read_pose(const CalibrationText& file, const YAML::Node& sensor) {
  const YAML::Node pose = sensor["T_BS"];
  return rigid_transform(yaml_numbers(file, pose && pose.IsMap() ? pose["data"] : pose, "T_BS"), file.path, "T_BS");
}

}  // namespace

CalibrationFile read_kalibr_camchain(const CalibrationText& file) {
  const YAML::Node root = load_yaml(file);
  if (root["cam0"] && !root["cam1"]) fail(file.path, ": the file has one camera; a pair is needed, cam0 and cam1");
  const YAML::Node left = require_camera(file, root, "cam0"), right = require_camera(file, root, "cam1");
  const cv::Matx44d left_to_right = read_nested_transform(file, right, "T_cn_cnm1");
  const StereoRig rig = join_cameras(read_camera(file, left, "distortion_coeffs"),
                                     read_camera(file, right, "distortion_coeffs"), left_to_right, file.path);
  return describe_rig(rig, "Kalibr camchain", file.path);
}

CalibrationFile read_euroc_sensors(const CalibrationText& left_file, const CalibrationText& right_file) {
  const YAML::Node left = load_yaml(left_file), right = load_yaml(right_file);
  const cv::Matx44d left_to_right = inverse(read_pose(right_file, right)) * read_pose(left_file, left);
  const std::string source = left_file.path + " and " + right_file.path;
  const StereoRig rig = join_cameras(read_camera(left_file, left, "distortion_coefficients"),
                                     read_camera(right_file, right, "distortion_coefficients"), left_to_right, source);
  return describe_rig(rig, "EuRoC sensor.yaml", source);
}

}  // namespace roadstereo::io
