#pragma once

#include "core/cuda/stream.hpp"
#include "stereo/coarse/cuda/coarse_volume.hpp"
#include "stereo/coarse/cuda/road_prior.hpp"
#include "stereo/coarse/path_winner.hpp"

namespace roadstereo::cuda {

/// Fills the band's costs: c(p, d) of eq. (8), of blocks with the prior's radius, plus the prior, and infinity behind
/// the last disparity. A disparity without a counterpart costs `uncorrelated_cost`. `roads` becomes what was added, and
/// `first_seen[v]` the first target column that all rows of the block around v see.
void block_costs(const CoarsePair& pair, float noise_variance, const RoadPrior& prior, const CoarseVolume& costs,
                 ImageView<RoadCost> roads, int* first_seen, StreamView stream);

}  // namespace roadstereo::cuda
