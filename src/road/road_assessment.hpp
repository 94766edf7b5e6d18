#pragma once

#include <optional>
#include <string>

#include "roadstereo/road_model.hpp"

namespace roadstereo {

/// Tells roads from walls: the sideways tilt of the plane. Without a calibration a usual lens stands in.
class TiltLimit {
 public:
  TiltLimit(int width, int height, const std::optional<StereoCalibration>& calibration, double max_tilt_deg);

  bool can_be_road(const DisparityPlane& plane) const;

  /// Prior weight of a plane that can be a road, above 0 … 1: rigs are mounted level, so that of two planes with
  /// similar evidence the less tilted one is the road. A normal distribution in the sine of the tilt, times
  /// `no_bonnet_weight`.
  double pose_weight(const DisparityPlane& plane) const;

  /// Prior weight of a plane as a road rather than a bonnet, above 0 … 1: 1 / (1 + (B/h)²), since roads are baselines B
  /// below the camera, h, and in proportion where less than three tenths of the rows lie below its horizon.
  double no_bonnet_weight(const DisparityPlane& plane) const;

  /// Share of the rows below the horizon, in the middle column.
  double share_below_horizon(const DisparityPlane& plane) const;

 private:
  /// Of the normal of the road, in units in which a2 is its part along the columns: baseline over height.
  double normal_length(const DisparityPlane& plane) const;

  double focal_, cx_, cy_, offset_, max_sine_, height_;
};

/// Weight of a plane, 0.1 … 1: roads are near the last frame's, ½ where tracking loses them. One with ten times the
/// evidence is taken wherever it is, as after a cut.
double weight_near(const DisparityPlane& plane, const DisparityPlane& last, double at_infinity, int width, int height);

/// What a search around a plane and a robust fit found.
struct PlaneFitStatistics {
  DisparityPlane plane;
  double scale_px = 0;  ///< of the fit
  int points = 0;       ///< correspondences
  int tried = 0;        ///< textured places of the road that both views see
  int inliers = 0;
  bool by_cells = false;   ///< whether places are cells of blocks, and not single blocks
  double correlation = 0;  ///< of blocks on the plane, 10th percentile; 0 when unknown
  bool found = false;
  double rows_covered = 0;  ///< share of the image height between the 5th and the 95th percentile of the inliers' rows
};

/// Fills in the estimate from the last search. Empty when the fit can be a road's, else why it cannot.
std::string assess_plane_fit(const PlaneFitStatistics& fit, const TiltLimit& limit, RoadModelEstimate& estimate);

/// A road found anew, by the mean evidence per pixel of its plane.
void assess_found_road(const PlaneFitStatistics& fit, double evidence, const TiltLimit& limit,
                       const RoadModelOptions& options, RoadModelEstimate& estimate);

/// The estimate from the two searches around the last frame's model, the first up to `range_px` away; all but the range
/// of the residuals.
RoadModelEstimate assess_tracked_road(const PlaneFitStatistics& around, const PlaneFitStatistics& close,
                                      const TrackedRoad& previous, int range_px, int width, int height,
                                      const std::optional<StereoCalibration>& calibration,
                                      const RoadModelOptions& options);

}  // namespace roadstereo
