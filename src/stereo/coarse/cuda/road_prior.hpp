#pragma once

#include <cuda_runtime_api.h>

#include "road/row_shift.hpp"
#include "stereo/coarse/block_uncertainty.hpp"
#include "stereo/coarse/cuda/coarse_volume.hpp"

namespace roadstereo::cuda {

/// How the road is guessed where the picture says nothing.
struct RoadPrior {
  PerspectiveShift shift;  ///< its road, δp
  float pull;              ///< cost of each coarse pixel away from the road where nothing is known
  float reach;             ///< coarse pixels away at which it stops growing
  UncertaintyParams texture_uncertainty;
  int block_radius;
};

/// Completes the band's costs: the guess, and infinity behind the last disparity.
void add_road_prior(const CoarsePair& pair, const RoadPrior& guess, const int* first_seen, const CoarseVolume& costs,
                    cudaStream_t stream);

}  // namespace roadstereo::cuda
