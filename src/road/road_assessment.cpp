#include "road/road_assessment.hpp"

#include <algorithm>
#include <cmath>

#include "core/degrees.hpp"
#include "core/format_message.hpp"
#include "road/road_search.hpp"

namespace roadstereo {
namespace {

/// Standard deviation of the sine of a rig's tilt, as a share of that of the limit.
constexpr double level_tilt = 0.33;
/// A tracked road must explain this much of what it explained in the last frame.
constexpr double min_share_of_last = 0.6;
constexpr double min_share = 0.1;  ///< in any case

/// Share of the textured samples of the road that the model explains.
double inlier_share(const PlaneFitStatistics& evidence) {
  return evidence.tried > 0 ? static_cast<double>(evidence.inliers) / evidence.tried : 0;
}

/// How far a plane has moved since the last frame: the largest change of its disparity in a corner of the image that
/// sees the road both times.
double max_move(const DisparityPlane& now, const DisparityPlane& before, double at_infinity, int width, int height) {
  double largest = 0;
  for (const double v : {0.0, height - 1.0}) {
    for (const double u : {0.0, width - 1.0}) {
      const double d = now.disparity(u, v), last = before.disparity(u, v);
      if (d > at_infinity && last > at_infinity) largest = std::max(largest, std::abs(d - last));
    }
  }
  return largest;
}

/// A road that has moved farther than this from one frame to the next has jumped: the search around the last frame's
/// plane, up to `range_px` away, may then have missed a part of it.
double max_step_px(int range_px, int width) {
  constexpr double share_of_range = 0.7;
  return share_of_range * range_px * fine_factor(width);
}

}  // namespace

TiltLimit::TiltLimit(int width, int height, const std::optional<StereoCalibration>& calibration, double max_tilt_deg)
    : focal_(calibration ? calibration->focal_px : 0.8 * width),
      cx_(calibration ? calibration->cx_px : width / 2.0),
      cy_(calibration ? calibration->cy_px : height / 2.0),
      offset_(calibration ? calibration->disparity_offset_px : 0),
      max_sine_(std::sin(to_radians(max_tilt_deg))),
      height_(height) {}

double TiltLimit::share_below_horizon(const DisparityPlane& plane) const {
  const double top = plane.disparity(cx_, 0) + offset_, bottom = plane.disparity(cx_, height_ - 1) + offset_;
  constexpr double least = 0.01;  // of a plane that is seen in a corner
  return top >= 0 ? 1 : std::max(least, bottom / (bottom - top));
}

double TiltLimit::normal_length(const DisparityPlane& plane) const {
  const double depth = (plane.disparity(cx_, cy_) + offset_) / focal_;
  return std::hypot(plane.a1, plane.a2, depth);
}

bool TiltLimit::can_be_road(const DisparityPlane& plane) const {
  const double length = normal_length(plane);
  // A road lies below the camera and is not seen from beneath.
  return length > 0 && std::abs(plane.a2) <= max_sine_ * length && plane.a1 >= -max_sine_ * length;
}

double TiltLimit::no_bonnet_weight(const DisparityPlane& plane) const {
  constexpr double usual_share = 0.3;
  const double baseline_over_height = normal_length(plane);
  return std::min(1.0, share_below_horizon(plane) / usual_share) / (1 + baseline_over_height * baseline_over_height);
}

double TiltLimit::pose_weight(const DisparityPlane& plane) const {
  const double baseline_over_height = normal_length(plane);
  const double tilt = plane.a2 / (baseline_over_height * max_sine_ * level_tilt);
  return std::exp(-0.5 * tilt * tilt) * no_bonnet_weight(plane);
}

double weight_near(const DisparityPlane& plane, const DisparityPlane& last, double at_infinity, int width, int height) {
  constexpr double least = 0.1;
  const double steps =
      max_move(plane, last, at_infinity, width, height) / max_step_px(first_search_again.range_px, width);
  return std::max(least, 1 / (1 + steps * steps));
}

std::string assess_plane_fit(const PlaneFitStatistics& fit, const TiltLimit& limit, RoadModelEstimate& estimate) {
  constexpr double min_rows_covered = 0.1;
  estimate.model = fit.plane;
  estimate.inliers = fit.inliers;
  estimate.inlier_share = inlier_share(fit);
  estimate.samples_are_cells = fit.by_cells;
  estimate.residual_px = fit.scale_px;
  if (!fit.found) return format_message("only ", fit.points, " correspondences lie near the supposed road");
  if (fit.rows_covered < min_rows_covered) {
    return format_message("the road was found in ", 100 * fit.rows_covered, " % of the rows only");
  }
  if (!limit.can_be_road(estimate.model)) return "the plane found is tilted like a wall";
  return {};
}

void assess_found_road(const PlaneFitStatistics& fit, double evidence, const TiltLimit& limit,
                       const RoadModelOptions& options, RoadModelEstimate& estimate) {
  estimate.evidence = evidence;
  estimate.correlation = fit.correlation;
  estimate.reason = assess_plane_fit(fit, limit, estimate);
  const double least = options.min_evidence / limit.no_bonnet_weight(fit.plane);
  if (estimate.reason.empty() && evidence < least) {
    estimate.reason = format_message("the evidence for a road is ", evidence, " per pixel, less than ", least);
  }
  if (estimate.reason.empty()) {
    estimate.status = evidence < options.weak_evidence ? RoadStatus::weak : RoadStatus::found;
  }
}

RoadModelEstimate assess_tracked_road(const PlaneFitStatistics& around, const PlaneFitStatistics& close,
                                      const TrackedRoad& previous, int range_px, int width, int height,
                                      const std::optional<StereoCalibration>& calibration,
                                      const RoadModelOptions& options) {
  RoadModelEstimate estimate;
  estimate.matches = around.points;
  estimate.correlation = close.correlation > 0 ? close.correlation : previous.correlation;
  const TiltLimit limit(width, height, calibration, options.max_road_tilt_deg);
  estimate.reason = assess_plane_fit(around.found ? close : around, limit, estimate);
  // In noise a plane explains far more of the cells than of the blocks: these need not explain as much.
  const bool are_fewer = previous.samples_are_cells && !estimate.samples_are_cells;
  const double least = std::max(min_share, are_fewer ? 0 : min_share_of_last * previous.inlier_share);
  const double at_infinity = calibration ? -calibration->disparity_offset_px : 0;
  const double moved = max_move(estimate.model, previous.model, at_infinity, width, height);
  if (!estimate.reason.empty()) return estimate;
  if (estimate.inlier_share < least) {
    estimate.reason =
        format_message("the last frame's road explains ", 100 * estimate.inlier_share,
                       " % of the textured samples where it should be seen, less than ", 100 * least, " %");
  } else if (estimate.residual_px > options.verify_tolerance_px * fine_factor(width)) {
    estimate.reason =
        format_message("the residual of the last frame's road in this frame is ", estimate.residual_px, " px");
  } else if (moved > max_step_px(range_px, width)) {
    estimate.reason = format_message("the road has moved by ", moved, " px since the last frame");
  } else {
    estimate.status = RoadStatus::tracked;
  }
  return estimate;
}

}  // namespace roadstereo
