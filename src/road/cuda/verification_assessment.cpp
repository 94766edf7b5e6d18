#include "road/cuda/verification_assessment.hpp"

#include "core/noise_correlation.hpp"
#include "road/road_assessment.hpp"
#include "road/road_search.hpp"

namespace roadstereo::cuda {
namespace {

PlaneFitStatistics statistics_of(const SearchStatistics& statistics, int height) {
  PlaneFitStatistics evidence;
  evidence.points = statistics.points;
  evidence.tried = statistics.tried;
  if (statistics.fit.found == 0) return evidence;
  evidence.plane = statistics.fit.plane;
  evidence.scale_px = statistics.fit.scale_px;
  evidence.inliers = statistics.inliers;
  evidence.found = statistics.found != 0;
  const double rows = statistics.highest_row - statistics.lowest_row;
  if (evidence.found) evidence.rows_covered = rows / height;
  return evidence;
}

}  // namespace

RoadModelEstimate assess_road_verification(const VerificationStatistics& statistics, const TrackedRoad& previous,
                                           int width, int height, const std::optional<StereoCalibration>& calibration,
                                           const RoadModelOptions& options) {
  const int factor = fine_factor(width);
  const int rows = height / factor * factor;
  PlaneFitStatistics close = statistics_of(statistics.close, rows);
  close.correlation = full_size_correlation(static_cast<double>(statistics.correlation), factor);
  RoadModelEstimate estimate = assess_tracked_road(statistics_of(statistics.around, rows), close, previous,
                                                   first_search_again.range_px, width, height, calibration, options);
  if (statistics.near >= min_matches) {
    estimate.residual_p01_px = statistics.residual_p01_px;
    estimate.residual_p99_px = statistics.residual_p99_px;
  }
  return estimate;
}

}  // namespace roadstereo::cuda
