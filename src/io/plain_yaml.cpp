#include "io/yaml_text.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

void require_plain_keys(const CalibrationText& file, const YAML::Node& root) {
  std::string missing;
  std::size_t count = 0;
  for (const char* key : {"focal_px", "cx_px", "cy_px", "baseline_m"}) {
    if (root[key]) continue;
    missing += (count++ == 0 ? "" : ", ") + std::string(key);
  }
  if (count == 0) return;
  const bool centre = !root["cx_px"] || !root["cy_px"];
  fail(file.path, ": ", missing, count > 1 ? " are missing" : " is missing",
       centre ? "; an unknown principal point is about the middle of the images, (width − 1) / 2 and (height − 1) / 2"
              : "");
}

}  // namespace

CalibrationFile read_plain_yaml(const CalibrationText& file) {
  const YAML::Node root = load_yaml(file);
  require_plain_keys(file, root);
  StereoCalibration calibration;
  calibration.focal_px = yaml_number(file, root, "focal_px");
  calibration.cx_px = yaml_number(file, root, "cx_px");
  calibration.cy_px = yaml_number(file, root, "cy_px");
  calibration.baseline_m = yaml_number(file, root, "baseline_m");
  if (root["disparity_offset_px"]) {
    calibration.disparity_offset_px = yaml_number(file, root, "disparity_offset_px");
  }
  calibration.width = yaml_side(file, root, "width");
  calibration.height = yaml_side(file, root, "height");
  check_rectified(calibration, file.path, {"focal_px", "cx_px", "cy_px", "baseline_m"});
  return {"plain YAML", calibration, std::nullopt};
}

}  // namespace roadstereo::io
