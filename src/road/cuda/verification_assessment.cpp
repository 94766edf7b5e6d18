#include "road/cuda/verification_assessment.hpp"

#include "road/road_assessment.hpp"
#include "road/road_search.hpp"

namespace roadstereo::cuda {
namespace {

PlaneFitStatistics evidence_of(const SearchStatistics& figures, int height) {
  PlaneFitStatistics evidence;
  evidence.points = figures.points;
  evidence.tried = figures.tried;
  if (figures.fit.found == 0) return evidence;
  const PlaneTerms& plane = figures.fit.plane;
  evidence.plane = {plane.a0, plane.a1, plane.a2};
  evidence.scale_px = figures.fit.scale_px;
  evidence.inliers = figures.inliers;
  evidence.found = figures.found != 0;
  const double rows = figures.highest_row - figures.lowest_row;
  if (evidence.found) evidence.rows_covered = rows / height;
  return evidence;
}

}  // namespace

RoadModelEstimate assess_road_verification(const VerificationFigures& figures, const TrackedRoad& previous,
                                           int width, int height, const std::optional<StereoCalibration>& calibration,
                                           const RoadModelOptions& options) {
  const int factor = fine_factor(width);
  const int rows = height / factor * factor;
  RoadModelEstimate estimate = assess_tracked_road(evidence_of(figures.around, rows), evidence_of(figures.close, rows),
                                                   previous, width, height, calibration, options);
  if (figures.near >= min_matches) {
    estimate.residual_p01_px = figures.residual_p01_px;
    estimate.residual_p99_px = figures.residual_p99_px;
  }
  return estimate;
}

}  // namespace roadstereo::cuda
