#pragma once

#include "road/cuda/fitted_plane.hpp"

namespace roadstereo::cuda {

/// What a search around a plane and the fit to what it found leave: PlaneFitStatistics of the device.
struct SearchStatistics {
  FittedPlane fit;
  int points;                     ///< correspondences
  int tried;                      ///< textured places of the road that both views see
  int inliers;                    ///< points with a weight
  int found;                      ///< 0: too few inliers
  float lowest_row, highest_row;  ///< 5th and 95th percentile of the inliers' rows, when found
};

/// What RoadVerification leaves for the host.
struct VerificationStatistics {
  SearchStatistics around, close;
  float residual_p01_px, residual_p99_px;  ///< 1st and 99th percentile of the residuals near the road
  int near;                                ///< correspondences near the road
  float correlation;                       ///< PlaneFitStatistics::correlation of the close search
};
static_assert(sizeof(VerificationStatistics) == 2 * sizeof(SearchStatistics) + 4 * sizeof(int));

}  // namespace roadstereo::cuda
