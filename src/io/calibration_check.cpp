#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/image_limits.hpp"
#include "io/calibration_formats.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/rigid_transform.hpp"

namespace roadstereo::io {
namespace {

constexpr double min_baseline_m = 0.005;
constexpr double max_baseline_m = 10;

void check_finite(double value, const std::string& source, const std::string& name) {
  if (std::isfinite(value)) return;
  fail(source, ": ", name, " is ", std::isnan(value) ? "nan" : "infinite", "; it must be a finite number");
}

void check_focal(double focal, int width, const std::string& source, const std::string& name) {
  check_finite(focal, source, name);
  const double min_focal = 0.2 * (width > 0 ? width : min_image_side);
  const double max_focal = 50.0 * (width > 0 ? width : max_image_side);
  if (!(focal >= min_focal && focal <= max_focal)) {
    fail(source, ": the focal length is ", focal, "; it must be between ", min_focal, " and ", max_focal, " pixels (",
         name, ")");
  }
}

void check_baseline(double baseline, const std::string& source, const std::string& name) {
  check_finite(baseline, source, name);
  if (baseline >= min_baseline_m && baseline <= max_baseline_m) return;
  const char* hint = baseline < 0 ? "; are the left and the right camera swapped?" : "";
  fail(source, ": the baseline is ", baseline == 0 ? 0.0 : baseline, "; it must be between ", min_baseline_m, " and ",
       max_baseline_m, " metres (", name, ")", hint);
}

bool is_rotation(const std::array<double, 9>& r) {
  constexpr double tolerance = 2e-3;  // files round to few digits
  const RigidTransform t{r[0], r[1], r[2], 0, r[3], r[4], r[5], 0, r[6], r[7], r[8], 0};
  return determinant(t) > 0 && rotation_error(t) < tolerance;
}

void check_matrix(const std::array<double, 9>& k, int width, const std::string& source, const std::string& name) {
  for (const double value : k) check_finite(value, source, name);
  check_focal(k[0], width, source, name + "[0]");
  check_focal(k[4], width, source, name + "[4]");
  if (k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    fail(source, ": ", name, " is not a camera matrix; it must be upper triangular and end with 1");
  }
  if (k[1] != 0) fail(source, ": ", name, "[1] is ", k[1], "; it must be 0, since skewed pixels are not supported");
}

void check_distortion(const std::vector<double>& d, bool fisheye, const std::string& source, const std::string& name) {
  for (const double value : d) check_finite(value, source, name);
  const std::size_t n = d.size();
  const bool known = fisheye ? n == 0 || n == 4 : n == 0 || n == 4 || n == 5 || n == 8 || n == 12 || n == 14;
  if (!known) {
    fail(source, ": ", name, " has ", n, " coefficients; ",
         fisheye ? "the fisheye model has 4" : "a lens model has 0, 4, 5, 8, 12 or 14");
  }
}

/// Whether both matrices are equal, without distortion, with parallel axes and a baseline along the rows.
bool needs_no_rectification(const StereoRig& rig) {
  constexpr double tolerance = 1e-9;
  const auto zero = [](double value) { return std::abs(value) <= tolerance; };
  const auto all_zero = [&](const std::vector<double>& d) { return std::all_of(d.begin(), d.end(), zero); };
  const auto& k = rig.left_matrix;
  for (std::size_t i = 0; i < k.size(); ++i) {
    if (!zero((k[i] - rig.right_matrix[i]) / k[0])) return false;
    if (!zero(rig.rotation[i] - (i % 4 == 0 ? 1.0 : 0.0))) return false;
  }
  return !rig.fisheye && zero((k[4] - k[0]) / k[0]) && all_zero(rig.left_distortion) &&
         all_zero(rig.right_distortion) && zero(rig.translation_m[1]) && zero(rig.translation_m[2]) &&
         rig.translation_m[0] < 0;
}

}  // namespace

void check_rectified(const StereoCalibration& calibration, const std::string& source, const FigureNames& names) {
  check_focal(calibration.focal_px, calibration.width, source, names.focal);
  check_finite(calibration.cx_px, source, names.cx);
  check_finite(calibration.cy_px, source, names.cy);
  check_finite(calibration.disparity_offset_px, source, "the disparity offset");
  check_baseline(calibration.baseline_m, source, names.baseline);
}

void check_one_projection(const std::string& source, const CameraFigures& left, const CameraFigures& right) {
  constexpr double row_tolerance_px = 0.5;
  if (std::abs(left.focal_px - right.focal_px) > 1e-6 * std::abs(left.focal_px)) {
    fail(source, ": ", left.name, " has the focal length ", left.focal_px, " and ", right.name, " has ", right.focal_px,
         "; a rectified pair has one");
  }
  if (std::abs(left.cy_px - right.cy_px) > row_tolerance_px) {
    fail(source, ": ", left.name, " has the principal point's row ", left.cy_px, " and ", right.name, " has ",
         right.cy_px, "; a rectified pair has one");
  }
}

void check_square_pixels(double fx, double fy, const std::string& source, const std::string& matrix) {
  constexpr double tolerance = 0.01;
  if (std::abs(fx - fy) > tolerance * std::abs(fx)) {
    fail(source, ": ", matrix, " has the focal lengths ", fx, " and ", fy, "; a rectified camera has one");
  }
}

void check_rig(const StereoRig& rig, const std::string& source) {
  check_matrix(rig.left_matrix, rig.width, source, "K1");
  check_matrix(rig.right_matrix, rig.width, source, "K2");
  check_distortion(rig.left_distortion, rig.fisheye, source, "D1");
  check_distortion(rig.right_distortion, rig.fisheye, source, "D2");
  for (const double value : rig.rotation) check_finite(value, source, "R");
  if (!is_rotation(rig.rotation)) fail(source, ": R is not a rotation; its rows must be orthonormal");
  for (const double value : rig.translation_m) check_finite(value, source, "T");
  const auto& t = rig.translation_m;
  check_baseline(std::hypot(t[0], t[1], t[2]), source, "the length of T");
}

std::string principal_point_doubt(double cx_px, double cy_px, int width, int height) {
  // Rectified rigs have the principal point at 0.36 to 0.51 of the size (KITTI, Middlebury): rectification displaces
  // it. Of pictures scaled to two thirds it is at 0.75; of others, by three quarters say, at the same share of both
  // sides.
  constexpr double far = 0.2, both = 0.1, equal_shares = 0.03;
  const double x = (cx_px + 0.5) / width - 0.5, y = (cy_px + 0.5) / height - 0.5;
  const bool is_far = std::abs(x) > far || std::abs(y) > far;
  const bool is_scaled = std::min(std::abs(x), std::abs(y)) > both && std::abs(x - y) < equal_shares;
  if (!is_far && !is_scaled) return "";
  const auto side = [](double centre) { return std::to_string(std::max(1L, std::lround(2 * centre + 1))); };
  std::ostringstream text;
  text << "it has no image size, and its principal point (" << cx_px << ", " << cy_px
       << ") lies far from the middle of images of " << width << "×" << height << " pixels: it suggests " << side(cx_px)
       << "×" << side(cy_px) << "; were the images scaled? Then scale the calibration, too";
  return text.str();
}

std::string CalibrationFile::size_doubt(int width, int height) const {
  if (rectified && rectified->width == 0)
    return principal_point_doubt(rectified->cx_px, rectified->cy_px, width, height);
  if (rig && rig->width == 0) return principal_point_doubt(rig->left_matrix[2], rig->left_matrix[5], width, height);
  return "";
}

CalibrationFile describe_rig(const StereoRig& rig, const std::string& format, const std::string& source) {
  check_rig(rig, source);
  CalibrationFile file;
  file.format = format;
  if (!needs_no_rectification(rig)) {
    file.rig = rig;
    return file;
  }
  StereoCalibration calibration;
  calibration.focal_px = rig.left_matrix[0];
  calibration.cx_px = rig.left_matrix[2];
  calibration.cy_px = rig.left_matrix[5];
  calibration.baseline_m = -rig.translation_m[0];
  calibration.width = rig.width;
  calibration.height = rig.height;
  file.rectified = calibration;
  return file;
}

}  // namespace roadstereo::io
