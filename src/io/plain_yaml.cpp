#include "io/yaml_text.hpp"

namespace roadstereo::io {

CalibrationFile read_plain_yaml(const CalibrationText& file) {
  const YAML::Node root = load_yaml(file);
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
