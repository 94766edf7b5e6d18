#pragma once

#include <cuda_runtime_api.h>

#include "road/row_shift.hpp"
#include "stereo/coarse/block_uncertainty.hpp"
#include "stereo/coarse/cuda/coarse_volume.hpp"

namespace roadstereo::cuda {

/// Road prior of pixels with weak texture.
struct RoadPrior {
  PerspectiveShift shift;  ///< its road, δp
  float weight;            ///< cost per coarse pixel of distance from the road, without texture
  float truncation;        ///< of that distance, coarse pixels
  UncertaintyParams texture_uncertainty;
  int block_radius;
};

/// Completes the band's costs: the prior, and infinity behind the last disparity.
void add_road_prior(const CoarsePair& pair, const RoadPrior& prior, const int* first_seen, const CoarseVolume& costs,
                    cudaStream_t stream);

}  // namespace roadstereo::cuda
