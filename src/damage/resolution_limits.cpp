#include "roadstereo/resolution_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/block_row_radius.hpp"
#include "core/degrees.hpp"
#include "core/require_range.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double max_distance_m = 1000;  // along Z
constexpr double right_angle = std::numbers::pi / 2;

/// Area of the support window of a disparity, pixels: the ellipse of the aggregation widened by the block.
double pixels_of_window(const MatcherOptions& matcher) {
  const double radius = matcher.aggregation_radius;
  const double columns = 2 * (radius + matcher.block_radius) + 1;
  const double rows = 2 * (matcher.aggregation_aspect * radius + block_row_radius(matcher)) + 1;
  return std::numbers::pi / 4 * columns * rows;
}

}  // namespace

void CameraPose::validate() const {
  require_range("camera_pose", "height_m", height_m, 0.05, 1000.0);
  require_range("camera_pose", "pitch_rad", pitch_rad, -right_angle, right_angle);
}

void ResolutionOptions::validate() const {
  require_range("resolution", "noise_px", noise_px, 0.0, 10.0);
  require_range("resolution", "threshold_sigma", threshold_sigma, 0.1, 100.0);
  require_range("resolution", "min_area_m2", min_area_m2, 0.0, 100.0);
  require_range("resolution", "rut_width_m", rut_width_m, 0.01, 10.0);
  require_range("resolution", "rut_length_m", rut_length_m, 0.01, 100.0);
  matcher.validate();
}

ResolutionLimits::ResolutionLimits(const StereoCalibration& calibration, const CameraPose& pose,
                                   const ResolutionOptions& options)
    : calibration_(calibration), pose_(pose), options_(options) {
  pose.validate();
  options.validate();
  if (calibration.width < 1 || calibration.height < 1) fail("the calibration has no image size; it must have one");
  calibration.validate(calibration.width, calibration.height, "the calibration");
  const double min_slant = pose.height_m / max_distance_m;
  if (slant(last_row()) < min_slant) {
    fail("the road is not in view: the camera looks ", to_degrees(pose.pitch_rad),
         "° below the horizon; the last row of the image must show the road within ", max_distance_m, " m");
  }
  while (first_row_ < last_row() && slant(first_row_) < min_slant) first_row_ += 1;
}

double ResolutionLimits::last_row() const {
  return calibration_.height - 1;
}

double ResolutionLimits::slant(double v) const {
  return std::cos(pose_.pitch_rad) * (v - calibration_.cy_px) / calibration_.focal_px + std::sin(pose_.pitch_rad);
}

double ResolutionLimits::road_disparity(double v) const {
  return calibration_.focal_px * calibration_.baseline_m * slant(v) / pose_.height_m;
}

double ResolutionLimits::depth_m(double v, double change_px) const {
  const double lower = road_disparity(v) - change_px;
  return lower > 0 ? pose_.height_m * change_px / lower : infinite;
}

RowResolution ResolutionLimits::at_row(double v) const {
  const double z = pose_.height_m / slant(v);
  const double tangent = (v - calibration_.cy_px) / calibration_.focal_px;
  const double f = calibration_.focal_px;
  RowResolution row;
  row.row_px = v;
  row.ahead_m = z * (std::cos(pose_.pitch_rad) - std::sin(pose_.pitch_rad) * tangent);
  row.distance_m = z * std::hypot(1.0, tangent);
  row.disparity_px = road_disparity(v) - calibration_.disparity_offset_px;
  row.step_m = depth_m(v, 1);
  row.std_error_m = pose_.height_m * std::hypot(options_.noise_px, sub_pixel_bias_px) / road_disparity(v);
  row.resolvable_depth_m = depth_m(v, resolvable_change_px(options_.noise_px, options_.threshold_sigma));
  row.gsd_across_m = z / f;
  row.gsd_along_m = z * z / (pose_.height_m * f);
  row.swath_m = std::clamp(calibration_.width - row.disparity_px, 0.0, double(calibration_.width)) * row.gsd_across_m;
  const double window_m2 = pixels_of_window(options_.matcher) * row.gsd_across_m * row.gsd_along_m;
  row.resolvable_area_m2 = std::max(options_.min_area_m2, window_m2);
  const double windows = std::max(1.0, options_.rut_width_m * options_.rut_length_m / window_m2);
  row.resolvable_rut_m =
      depth_m(v, resolvable_change_px(options_.noise_px / std::sqrt(windows), options_.threshold_sigma));
  return row;
}

std::vector<RowResolution> ResolutionLimits::rows(int count) const {
  require_range("limits", "count", count, 2, 1 << 16);
  const int steps = count - 1;
  std::vector<RowResolution> rows;
  rows.reserve(static_cast<std::size_t>(steps) + 1);
  for (int i = 0; i <= steps; ++i) rows.push_back(at_row(last_row() + (first_row_ - last_row()) * i / steps));
  return rows;
}

std::optional<RowResolution> ResolutionLimits::farthest(double depth_m) const {
  const double change = resolvable_change_px(options_.noise_px, options_.threshold_sigma);
  const auto is_resolved = [&](double v) { return this->depth_m(v, change) <= depth_m; };
  // Bisection: disparities do not increase from the last row to the first.
  double near = last_row(), far = first_row_;
  if (!is_resolved(near)) return std::nullopt;
  if (is_resolved(far)) return at_row(far);
  constexpr double tolerance_px = 0.01;
  while (near - far > tolerance_px) {
    const double middle = (near + far) / 2;
    (is_resolved(middle) ? near : far) = middle;
  }
  return at_row(near);
}

double ResolutionLimits::max_camera_height_m(double depth_m) const {
  // h·δ / (D − δ) = depth with D = f·b·slant / h: h² / depth + h = f·b·slant / δ
  const double change = resolvable_change_px(options_.noise_px, options_.threshold_sigma);
  const double right =
      calibration_.focal_px * calibration_.baseline_m * slant((calibration_.height - 1) / 2.0) / change;
  return right > 0 ? depth_m / 2 * (std::sqrt(1 + 4 * right / depth_m) - 1) : 0;
}

}  // namespace roadstereo
