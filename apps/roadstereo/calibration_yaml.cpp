#include "calibration_yaml.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <array>
#include <span>
#include <vector>

namespace roadstereo::cli {
namespace {

std::string matrix_yaml(const char* key, int rows, std::span<const double> values) {
  return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: [ {} ]\n", key, rows,
                     values.size() / static_cast<std::size_t>(rows), fmt::join(values, ", "));
}

std::string distortion_yaml(const char* key, const std::vector<double>& coefficients) {
  constexpr std::array<double, 4> none{};
  return matrix_yaml(key, 1, coefficients.empty() ? std::span<const double>(none) : coefficients);
}

}  // namespace

std::string plain_yaml(const StereoCalibration& calibration) {
  std::string text = fmt::format(
      "# Rectified pair: focal length and principal point in pixels, baseline in metres.\n"
      "focal_px: {}\ncx_px: {}\ncy_px: {}\nbaseline_m: {}\nwidth: {}\nheight: {}\n",
      calibration.focal_px, calibration.cx_px, calibration.cy_px, calibration.baseline_m, calibration.width,
      calibration.height);
  if (calibration.disparity_offset_px != 0) {
    text += fmt::format("disparity_offset_px: {}\n", calibration.disparity_offset_px);
  }
  return text;
}

std::string opencv_yaml(const io::StereoRig& rig) {
  std::string text = "%YAML:1.0\n---\n";
  if (rig.width > 0) text += fmt::format("image_width: {}\nimage_height: {}\n", rig.width, rig.height);
  text += fmt::format("camera_model: \"{}\"\n", rig.fisheye ? "fisheye" : "pinhole");
  text += matrix_yaml("K1", 3, rig.left_matrix) + distortion_yaml("D1", rig.left_distortion);
  text += matrix_yaml("K2", 3, rig.right_matrix) + distortion_yaml("D2", rig.right_distortion);
  return text + matrix_yaml("R", 3, rig.rotation) + matrix_yaml("T", 3, rig.translation_m);
}

}  // namespace roadstereo::cli
