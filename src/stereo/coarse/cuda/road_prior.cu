// Floor: 12 bytes and 5 operations a cost (read for its chance, read again and written), and of a pixel 28 gradients:
// 320×180 pixels of 24 disparities: 17 MB that lie in the second cache.

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

/// What is known of a pixel before its costs.
struct PixelGuess {
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

__device__ PixelGuess guess_of(const GradientSums* columns, const RoadPrior& guess, int factor, int u, int v) {
  GradientSums block{0, 0};
  for (int k = 0; k <= 2 * guess.block_radius; ++k) {
    block.squares += columns[k].squares;
    block.products += columns[k].products;
  }
  return {coarse_road(guess.shift, u, v, factor, nanf("")),
          texture_uncertainty(block.squares, block.products, guess.texture_uncertainty)};
}

/// What the pull of a pixel is, found by a whole warp.
__device__ float pull_of(const PixelGuess& pixel, const RoadPrior& guess, const float* cost, int count) {
  const float pull = guess.pull * pixel.texture_uncertainty;
  if (count <= 0 || pixel.texture_uncertainty < knows_enough) return pull;
  const NearRoad near = near_road(pixel.road, count);
  float at_road = no_evidence, least = no_evidence;
  for (int d = static_cast<int>(threadIdx.x) % warp_lanes; d < count; d += warp_lanes) {
    least = fminf(least, cost[d]);
    if (d >= near.first && d < near.end) at_road = fminf(at_road, cost[d]);
  }
  return pull * cost_plausibility(warp_min(at_road), warp_min(least));
}

/// Completes the costs of one pixel, with a whole warp.
__device__ void complete_pixel(const PixelGuess& pixel, const RoadPrior& guess, const CoarseVolume& costs, float* cost,
                               int count) {
  const bool known = pixel.road == pixel.road;
  const float pull = known ? pull_of(pixel, guess, cost, count) : 0;
  for (int d = static_cast<int>(threadIdx.x) % warp_lanes; d < costs.pitch; d += warp_lanes) {
    if (d >= costs.disparities) {
      cost[d] = INFINITY;
    } else if (known) {
      cost[d] = fmaf(pull, fminf(fabsf(static_cast<float>(d) - pixel.road), guess.reach), cost[d]);
    }
  }
}

__global__ void complete_costs(CoarsePair pair, RoadPrior guess, const int* first_seen, CoarseVolume costs) {
  const int v = costs.first_row + static_cast<int>(blockIdx.y);
  const int first = static_cast<int>(blockIdx.x) * segment, columns = segment + 2 * guess.block_radius;
  const auto thread = static_cast<int>(threadIdx.x);
  auto* gradients = shared_memory<GradientSums>();
  auto* guesses = reinterpret_cast<PixelGuess*>(gradients + columns);
  if (thread < columns) {
    gradients[thread] = column_gradients(pair.reference, first - guess.block_radius + thread, v, guess.block_radius);
  }
  __syncthreads();
  if (thread < segment) guesses[thread] = guess_of(gradients + thread, guess, pair.factor, first + thread, v);
  __syncthreads();
  for (int k = thread / warp_lanes; k < segment && first + k < costs.columns; k += warps) {
    const int u = first + k, seen = u - first_seen[v] + 1;
    complete_pixel(guesses[k], guess, costs, costs.pixel(u, v), seen < costs.disparities ? seen : costs.disparities);
  }
}

}  // namespace

void add_road_prior(const CoarsePair& pair, const RoadPrior& guess, const int* first_seen, const CoarseVolume& costs,
                    cudaStream_t stream) {
  const auto columns = static_cast<std::size_t>(segment + 2 * guess.block_radius);
  launch(complete_costs,
         {dim3(blocks_for(costs.columns, segment), static_cast<unsigned>(costs.rows)), warps * warp_lanes,
          columns * sizeof(GradientSums) + segment * sizeof(PixelGuess)},
         stream, pair, guess, first_seen, costs);
}

}  // namespace roadstereo::cuda
