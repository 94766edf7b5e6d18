#pragma once

#include "core/cuda/warp.hpp"
#include "stereo/coarse/coarse_road.hpp"
#include "stereo/coarse/cuda/coarse_volume.hpp"
#include "stereo/coarse/cuda/road_prior.hpp"
#include "stereo/coarse/path_winner.hpp"
#include "stereo/coarse/road_plausibility.hpp"

// The road as prior of the costs of a pixel. For kernels.

namespace roadstereo::cuda {

/// Sums of the gradients of one column over the rows of a block.
struct alignas(8) GradientSums {
  int squares, products;
};

/// Road, coarse pixels, NaN above the horizon and without one, texture uncertainty of a pixel, and what a distance from
/// the road costs where that is plausible.
struct PixelPrior {
  float road, texture_uncertainty;
  DistanceCost away;
};

/// Pixels at the border have no gradient.
__device__ inline GradientSums column_gradients(const ImageView<const std::int16_t>& image, int u, int v, int radius) {
  GradientSums sums{0, 0};
  if (u < 1 || u + 1 >= image.width()) return sums;
  const int first = v - radius < 1 ? 1 : v - radius;
  const int last = v + radius > image.height() - 2 ? image.height() - 2 : v + radius;
  for (int row = first; row <= last; ++row) {
    const std::int16_t* at = image.row(row) + u;
    const CoarseGradient gradient =
        coarse_gradient(__ldg(at - 1), __ldg(at + 1), __ldg(at - image.stride()), __ldg(at + image.stride()));
    sums.squares += gradient.across * gradient.across;
    sums.products += gradient.across * gradient.down;
  }
  return sums;
}

/// Of column u, whose block begins at `columns`.
__device__ inline PixelPrior prior_of(const GradientSums* columns, const RoadPrior& prior, const CoarseRoad& road,
                                      int u) {
  GradientSums block{0, 0};
  for (int k = 0; k <= 2 * prior.block_radius; ++k) {
    block.squares += columns[k].squares;
    block.products += columns[k].products;
  }
  const float disparity = road.disparity(u);
  const float uncertainty = texture_uncertainty(block.squares, block.products, prior.texture_uncertainty);
  return {road.shifted(disparity), uncertainty, prior.heights.at(disparity, uncertainty)};
}

/// Weight of the prior of a pixel with costs of `count` disparities; `smallest_cost(first, end)` is that of a range of
/// them, found by a whole warp.
template <class SmallestCost>
__device__ float weight_of(const PixelPrior& pixel, int count, SmallestCost smallest_cost) {
  if (count <= 0 || pixel.texture_uncertainty < min_uncertainty) return pixel.away.weight;
  const NearRoad near = near_road(pixel.road, count);
  return pixel.away.weight * cost_plausibility(smallest_cost(near.first, near.end), smallest_cost(0, count));
}

/// A cost with the prior.
__device__ inline float with_prior(float cost, int d, const PixelPrior& pixel, float weight) {
  const float away = fminf(fabsf(static_cast<float>(d) - pixel.road), pixel.away.truncation);
  return fmaf(weight * away, away, cost);
}

/// Completes the costs of a pixel in memory, with a whole warp: the prior, and infinity behind the last disparity.
/// Returns what the prior costs.
__device__ inline RoadCost complete_costs(const PixelPrior& pixel, const CoarseVolume& costs, float* cost, int count) {
  const int lane = static_cast<int>(threadIdx.x) % warp_lanes;
  const bool known = pixel.road == pixel.road;
  const auto smallest_cost = [&](int first, int end) {
    float smallest = uncorrelated_cost;
    for (int d = first + lane; d < end; d += warp_lanes) smallest = fminf(smallest, cost[d]);
    return warp_min(smallest);
  };
  const float weight = known ? weight_of(pixel, count, smallest_cost) : 0;
  for (int d = lane; d < costs.pitch; d += warp_lanes) {
    if (d >= costs.disparities) {
      cost[d] = INFINITY;
    } else if (known) {
      cost[d] = with_prior(cost[d], d, pixel, weight);
    }
  }
  return {pixel.road, weight, pixel.away.truncation};
}

/// The same of the cost that each lane of a warp holds, for at most as many disparities as there are lanes.
__device__ inline RoadCost complete_cost(const PixelPrior& pixel, const CoarseVolume& costs, float& cost, int count) {
  const int d = static_cast<int>(threadIdx.x) % warp_lanes;
  const auto smallest_cost = [&](int first, int end) {
    return warp_min(d >= first && d < end ? fminf(cost, uncorrelated_cost) : uncorrelated_cost);
  };
  const bool known = pixel.road == pixel.road;
  const float weight = known ? weight_of(pixel, count, smallest_cost) : 0;
  if (d >= costs.disparities) {
    cost = INFINITY;
  } else if (known) {
    cost = with_prior(cost, d, pixel, weight);
  }
  return {pixel.road, weight, pixel.away.truncation};
}

}  // namespace roadstereo::cuda
