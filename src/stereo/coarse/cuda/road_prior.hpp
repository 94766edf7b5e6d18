#pragma once

#include "road/row_shift.hpp"
#include "stereo/coarse/block_uncertainty.hpp"

namespace roadstereo::cuda {

/// Road prior of pixels with weak texture.
struct RoadPrior {
  PerspectiveShift shift;  ///< its road, δp
  float weight;            ///< cost per coarse pixel of distance from the road, without texture
  float truncation;        ///< of that distance, coarse pixels
  UncertaintyParams texture_uncertainty;
  int block_radius;
};

}  // namespace roadstereo::cuda
