#include <cmath>
#include <nlohmann/json.hpp>

#include "io/calibration_formats.hpp"
#include "io/rig_camera.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// The viewer writes every number as text.
double number(const CalibrationText& file, const nlohmann::json& root, const std::string& key) {
  if (!root.contains(key)) fail(file.path, ": ", key, " is missing");
  const nlohmann::json& value = root[key];
  if (!value.is_string() && !value.is_number()) fail(file.path, ": ", key, " must be a number");
  return parse_number(file.path, key, value.is_string() ? value.get<std::string>() : value.dump());
}

}  // namespace

/// The camera rectifies its infrared images itself: "rectified.N" is the camera matrix of both at one size, without
/// distortion.
CalibrationFile read_realsense(const CalibrationText& file) {
  const nlohmann::json root = nlohmann::json::parse(file.text, nullptr, false);
  if (!root.is_object()) fail(file.path, ": invalid JSON");
  constexpr double mm = 1e-3;
  const double baseline_m = mm * std::abs(number(file, root, "baseline"));
  CalibrationFile result;
  result.format = "RealSense";
  for (int i = 0; root.contains("rectified." + std::to_string(i) + ".fx"); ++i) {
    const auto value = [&](const char* name) {
      return number(file, root, "rectified." + std::to_string(i) + "." + name);
    };
    if (value("width") == 0 || value("height") == 0 || value("fx") == 0) continue;  // a size that is not used
    StereoRig rig;
    rig.left_matrix = rig.right_matrix = camera_matrix(value("fx"), value("fy"), value("ppx"), value("ppy"));
    rig.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    rig.translation_m = {-baseline_m, 0, 0};
    const std::string name = "rectified." + std::to_string(i);
    rig.width = image_side(file.path, name + ".width", value("width"));
    rig.height = image_side(file.path, name + ".height", value("height"));
    check_rig(rig, file.path);
    result.rigs.push_back(rig);
  }
  if (result.rigs.empty()) fail(file.path, ": there is no size of the images with a focal length");
  return result;
}

}  // namespace roadstereo::io
