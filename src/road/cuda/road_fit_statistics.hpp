#pragma once

#include "road/cuda/fitted_plane.hpp"
#include "road/map_sample.hpp"

namespace roadstereo::cuda {

/// What RoadFit leaves for the host.
struct RoadFitStatistics {
  DisparityPlane plane;  ///< comes first, so that its address serves as a PlaneSource
  FittedPlane fit;       ///< not found: the plane is that of least squares
  int points;            ///< valid disparities of the sample
  int has_plane;         ///< 0: all of them lie on one line of the image, or there are none
  FitMoments moments;
};

}  // namespace roadstereo::cuda
