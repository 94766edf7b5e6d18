// Floor: 12 bytes and 5 operations a cost (read for its plausibility, read again and written), and of a pixel 28
// gradients: 320×180 pixels of 24 disparities: 17 MB that lie in the second cache.

#include "core/cuda/launch.hpp"
#include "core/cuda/warp.hpp"
#include "stereo/coarse/cuda/road_prior.hpp"
#include "stereo/coarse/road_plausibility.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int warps = 4;
constexpr int segment = 32;  // columns of a block

/// Sums of the gradients of one column over the rows of a block.
struct alignas(8) GradientSums {
  int squares, products;
};

/// Road and texture of a pixel.
struct PixelPrior {
  float road, texture_uncertainty;
};

/// Pixels at the border have no gradient.
__device__ GradientSums column_gradients(const ImageView<const std::int16_t>& image, int u, int v, int radius) {
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

__device__ PixelPrior prior_of(const GradientSums* columns, const RoadPrior& prior, int factor, int u, int v) {
  GradientSums block{0, 0};
  for (int k = 0; k <= 2 * prior.block_radius; ++k) {
    block.squares += columns[k].squares;
    block.products += columns[k].products;
  }
  return {coarse_road(prior.shift, u, v, factor, nanf("")),
          texture_uncertainty(block.squares, block.products, prior.texture_uncertainty)};
}

/// Weight of the prior of a pixel, computed by a whole warp.
__device__ float weight_of(const PixelPrior& pixel, const RoadPrior& prior, const float* cost, int count) {
  const float weight = prior.weight * pixel.texture_uncertainty;
  if (count <= 0 || pixel.texture_uncertainty < min_uncertainty) return weight;
  const NearRoad near = near_road(pixel.road, count);
  float at_road = uncorrelated_cost, smallest = uncorrelated_cost;
  for (int d = static_cast<int>(threadIdx.x) % warp_lanes; d < count; d += warp_lanes) {
    smallest = fminf(smallest, cost[d]);
    if (d >= near.first && d < near.end) at_road = fminf(at_road, cost[d]);
  }
  return weight * cost_plausibility(warp_min(at_road), warp_min(smallest));
}

/// Completes the costs of one pixel, with a whole warp.
__device__ void complete_pixel(const PixelPrior& pixel, const RoadPrior& prior, const CoarseVolume& costs, float* cost,
                               int count) {
  const bool known = pixel.road == pixel.road;
  const float weight = known ? weight_of(pixel, prior, cost, count) : 0;
  for (int d = static_cast<int>(threadIdx.x) % warp_lanes; d < costs.pitch; d += warp_lanes) {
    if (d >= costs.disparities) {
      cost[d] = INFINITY;
    } else if (known) {
      cost[d] = fmaf(weight, fminf(fabsf(static_cast<float>(d) - pixel.road), prior.truncation), cost[d]);
    }
  }
}

__global__ void complete_costs(CoarsePair pair, RoadPrior prior, const int* first_seen, CoarseVolume costs) {
  const int v = costs.first_row + static_cast<int>(blockIdx.y);
  const int first = static_cast<int>(blockIdx.x) * segment, columns = segment + 2 * prior.block_radius;
  const auto thread = static_cast<int>(threadIdx.x);
  auto* gradients = shared_memory<GradientSums>();
  auto* priors = reinterpret_cast<PixelPrior*>(gradients + columns);
  if (thread < columns) {
    gradients[thread] = column_gradients(pair.reference, first - prior.block_radius + thread, v, prior.block_radius);
  }
  __syncthreads();
  if (thread < segment) priors[thread] = prior_of(gradients + thread, prior, pair.factor, first + thread, v);
  __syncthreads();
  for (int k = thread / warp_lanes; k < segment && first + k < costs.columns; k += warps) {
    const int u = first + k, seen = u - first_seen[v] + 1;
    complete_pixel(priors[k], prior, costs, costs.pixel(u, v), seen < costs.disparities ? seen : costs.disparities);
  }
}

}  // namespace

void add_road_prior(const CoarsePair& pair, const RoadPrior& prior, const int* first_seen, const CoarseVolume& costs,
                    cudaStream_t stream) {
  const auto columns = static_cast<std::size_t>(segment + 2 * prior.block_radius);
  launch(complete_costs,
         {dim3(blocks_for(costs.columns, segment), static_cast<unsigned>(costs.rows)), warps * warp_lanes,
          columns * sizeof(GradientSums) + segment * sizeof(PixelPrior)},
         stream, pair, prior, first_seen, costs);
}

}  // namespace roadstereo::cuda
