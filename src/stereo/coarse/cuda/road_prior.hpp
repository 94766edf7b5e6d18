#pragma once

#include "roadstereo/perspective_shift.hpp"
#include "stereo/coarse/block_uncertainty.hpp"
#include "stereo/coarse/height_prior.hpp"

namespace roadstereo::cuda {

/// Road prior of pixels with weak texture.
struct RoadPrior {
  PerspectiveShift shift;  ///< its road, δp
  HeightPrior heights;
  UncertaintyParams texture_uncertainty;
  int block_radius;
};

}  // namespace roadstereo::cuda
