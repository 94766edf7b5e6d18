#include "road/cuda/verification_judgement.hpp"

#include "road/road_judgement.hpp"
#include "road/road_search.hpp"

namespace roadstereo::cuda {
namespace {

RoadEvidence evidence_of(const SearchFigures& figures, int height) {
  RoadEvidence evidence;
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

RoadModelEstimate judge_verification(const VerificationFigures& figures, const RoadModel& previous, int width,
                                     int height, const std::optional<StereoCalibration>& calibration,
                                     const RoadModelOptions& options) {
  const int factor = fine_factor(width);
  const int rows = height / factor * factor;
  RoadModelEstimate estimate = judge_again(evidence_of(figures.around, rows), evidence_of(figures.close, rows),
                                           previous, width, height, calibration, options);
  if (figures.near >= fewest_matches) {
    estimate.lowest_px = figures.lowest_px;
    estimate.highest_px = figures.highest_px;
  }
  return estimate;
}

}  // namespace roadstereo::cuda
