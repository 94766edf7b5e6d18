#include "inspection_limits.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "roadstereo/resolution_limits.hpp"

namespace roadstereo::cli {
namespace {

/// The first row, 0 … height, below which the plane has positive disparities in this column.
double horizon_row(const DisparityPlane& plane, double u, int height) {
  const double at_top = plane.disparity(u, 0), at_bottom = plane.disparity(u, height);
  if (at_top > 0) return 0;
  if (at_bottom <= 0) return height;
  return height * at_top / (at_top - at_bottom);
}

}  // namespace

std::optional<ResolvedDepth> resolved_depth(const RoadView& view, const StereoCalibration& calibration,
                                            const DamageOptions& options) {
  if (calibration.width < 1 || calibration.height < 1) return std::nullopt;
  const double u = 0.5 * (calibration.width - 1);
  const double v = 0.5 * (horizon_row(view.plane, u, calibration.height) + calibration.height - 1);
  const double disparity = view.plane.disparity(u, v) + calibration.disparity_offset_px;
  const double change = resolvable_change_px(view.noise_px, options.threshold_sigma);
  if (!std::isfinite(view.height_m) || !(disparity > change)) return std::nullopt;
  const double z = calibration.focal_px * calibration.baseline_m / disparity;
  const double x = (u - calibration.cx_px) / calibration.focal_px, y = (v - calibration.cy_px) / calibration.focal_px;
  const double depth = view.height_m * change / (disparity - change);
  return ResolvedDepth{std::max(depth, options.min_depth_m), z * std::hypot(x, y, 1.0)};
}

double share_below_horizon(const DisparityPlane& plane, int width, int height) {
  double rows = 0;
  for (int u = 0; u < width; ++u) rows += height - horizon_row(plane, u, height);
  return rows / (static_cast<double>(width) * height);
}

std::vector<std::string> doubts_of(const std::vector<HealthFinding>& findings) {
  std::vector<std::string> doubts;
  for (const HealthFinding& finding : findings) {
    if (finding.spoils_depth) doubts.push_back(finding.text);
  }
  return doubts;
}

std::vector<std::string> doubts_of(const std::vector<HealthFinding>& findings, const RoadView& view, int width,
                                   int height) {
  constexpr double min_share = 0.5;  // of the road; what lies above the horizon may have disparities or none
  std::vector<std::string> doubts = doubts_of(findings);
  const double road = share_below_horizon(view.plane, width, height);
  if (!(view.valid_share >= min_share * road)) {
    doubts.push_back(fmt::format("only {:.0f} % of the pixels have a disparity, and {:.0f} % lie below the horizon",
                                 100 * view.valid_share, 100 * road));
  }
  return doubts;
}

std::string limit_text(const std::optional<ResolvedDepth>& depth, double noise_px, const DamageOptions& options) {
  if (depth) {
    return fmt::format(
        "a depth or height of about {:.0f} mm at {:.2f} m from the camera, the middle of the road in view, "
        "and more beyond",
        std::ceil(1000 * depth->depth_m), depth->distance_m);
  }
  if (!std::isfinite(noise_px)) return {};
  return fmt::format("a change of the disparity by {:.2f} px", resolvable_change_px(noise_px, options.threshold_sigma));
}

}  // namespace roadstereo::cli
