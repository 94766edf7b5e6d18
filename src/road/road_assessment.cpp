#include "road/road_assessment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/format_message.hpp"

namespace roadstereo {
namespace {

constexpr double min_share_again = 0.5;  ///< that a carried-over model explains; to look anew costs only time

/// Share of the textured places of the road that the model explains.
double inlier_share(const PlaneFitStatistics& evidence) {
  return evidence.tried > 0 ? static_cast<double>(evidence.inliers) / evidence.tried : 0;
}

/// How far a plane has moved since the last frame: the largest change of its disparity in a corner of the image that
/// sees the road both times.
double max_move(const DisparityPlane& now, const DisparityPlane& before, int width, int height) {
  double largest = 0;
  for (const double v : {0.0, height - 1.0}) {
    for (const double u : {0.0, width - 1.0}) {
      const double d = now.disparity(u, v), last = before.disparity(u, v);
      if (d > 0 && last > 0) largest = std::max(largest, std::abs(d - last));
    }
  }
  return largest;
}

/// A road that has moved further than this from one frame to the next has jumped: then nothing says that the search
/// around the last frame's plane has seen all of it. In a smooth flight it moves a tenth as far.
double max_step_px(int width) {
  constexpr double share_of_width = 1.0 / 640, min_px = 0.25;
  return std::max(min_px, share_of_width * width);
}

}  // namespace

TiltLimit::TiltLimit(int width, int height, const std::optional<StereoCalibration>& calibration, double max_tilt_deg)
    : focal_(calibration ? calibration->focal_px : 0.8 * width),
      cx_(calibration ? calibration->cx_px : width / 2.0),
      cy_(calibration ? calibration->cy_px : height / 2.0),
      offset_(calibration ? calibration->disparity_offset_px : 0),
      max_sine_(std::sin(max_tilt_deg * std::numbers::pi / 180)) {}

bool TiltLimit::can_be_road(const DisparityPlane& plane) const {
  const double depth = (plane.disparity(cx_, cy_) + offset_) / focal_;
  const double length = std::hypot(plane.a1, plane.a2, depth);
  // A road lies below the camera and is not seen from beneath.
  return length > 0 && std::abs(plane.a2) <= max_sine_ * length && plane.a1 >= -max_sine_ * length;
}

void judge(const PlaneFitStatistics& evidence, double min_share, const TiltLimit& limit, RoadModelEstimate& estimate) {
  constexpr double min_rows_covered = 0.1;
  estimate.model = evidence.plane;
  estimate.inliers = evidence.inliers;
  estimate.residual_px = evidence.scale_px;
  const double share = inlier_share(evidence);
  if (!evidence.found) {
    estimate.reason = format_message("only ", evidence.points, " correspondences lie near the supposed road");
  } else if (share < min_share) {
    estimate.reason =
        format_message("the road explains ", 100 * share, " % of the textured places where it should be seen, ",
                       "less than ", 100 * min_share, " %");
  } else if (evidence.rows_covered < min_rows_covered) {
    estimate.reason = format_message("the road was found in ", 100 * evidence.rows_covered, " % of the rows only");
  } else if (!limit.can_be_road(estimate.model)) {
    estimate.reason = "the plane found is tilted like a wall";
  } else {
    estimate.reliable = true;
  }
}

RoadModelEstimate assess_tracked_road(const PlaneFitStatistics& around, const PlaneFitStatistics& close,
                                      const DisparityPlane& previous, int width, int height,
                                      const std::optional<StereoCalibration>& calibration,
                                      const RoadModelOptions& options) {
  RoadModelEstimate estimate;
  estimate.tracked = true;
  estimate.matches = around.points;
  const TiltLimit limit(width, height, calibration, options.max_road_tilt_deg);
  judge(close, std::max(options.min_inlier_share, min_share_again), limit, estimate);
  if (estimate.reliable && estimate.residual_px > options.verify_tolerance_px) {
    estimate.reliable = false;
    estimate.reason = format_message("the last frame's road leaves ", estimate.residual_px, " px on this one");
  }
  const double moved = max_move(estimate.model, previous, width, height);
  if (estimate.reliable && moved > max_step_px(width)) {
    estimate.reliable = false;
    estimate.reason = format_message("the road has moved by ", moved, " px since the last frame");
  }
  return estimate;
}

}  // namespace roadstereo
