#pragma once

#include <cuda_runtime_api.h>

#include "stereo/coarse/cuda/coarse_volume.hpp"

namespace roadstereo::cuda {

/// Fills the band's costs c(p, d) of eq. (8), of blocks with the radius given; a disparity without a counterpart costs
/// `uncorrelated_cost`. `first_seen[v]` becomes the first target column that all rows of the block around v see.
void block_costs(const CoarsePair& pair, int block_radius, float noise_variance, const CoarseVolume& costs,
                 int* first_seen, cudaStream_t stream);

}  // namespace roadstereo::cuda
