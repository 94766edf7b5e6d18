#pragma once

#include <optional>

#include "roadstereo/road_model.hpp"

namespace roadstereo {

/// Tells roads from walls: the sideways tilt of the plane. Without a calibration a usual lens stands in; it decides
/// nothing but what cannot be a road.
class TiltLimit {
 public:
  TiltLimit(int width, int height, const std::optional<StereoCalibration>& calibration, double max_tilt_deg);

  bool can_be_road(const DisparityPlane& plane) const;

 private:
  double focal_, cx_, cy_, offset_, max_sine_;
};

/// What a search around a plane and a robust fit found.
struct PlaneFitStatistics {
  DisparityPlane plane;
  double scale_px = 0;  ///< of the fit
  int points = 0;       ///< correspondences
  int tried = 0;        ///< textured places of the road that both views see
  int inliers = 0;
  bool found = false;
  double rows_covered = 0;  ///< share of the image height between the 5th and the 95th percentile of the inliers' rows
};

/// Fills in the estimate from the last search and says whether, and if not why not, it can be trusted.
void judge(const PlaneFitStatistics& evidence, double min_share, const TiltLimit& limit, RoadModelEstimate& estimate);

/// The estimate from the two searches around the last frame's model; all but the range of the residuals.
RoadModelEstimate assess_tracked_road(const PlaneFitStatistics& around, const PlaneFitStatistics& close,
                                      const DisparityPlane& previous, int width, int height,
                                      const std::optional<StereoCalibration>& calibration,
                                      const RoadModelOptions& options);

}  // namespace roadstereo
