#include "core/cuda/launch.hpp"
#include "stereo/cuda/finish_rows.hpp"

// Floor per pixel: 12 bytes read, 10 written: 5 MB at 640×360, 1.1 µs of an H200's 4.8 TB/s.

namespace roadstereo::cuda {
namespace {

/// The disparity of a winner: NaN where it is not to be trusted. `variance` becomes that of what fails the check.
__device__ float finish(int winner, int target_winner, float offset, const FinishSettings& settings, float& variance) {
  if (winner < 0) return NAN;
  const auto difference = static_cast<float>(winner - target_winner);
  if (settings.left_right_check && difference * difference > settings.consistency) {
    if (settings.hidden_variance == 0) return NAN;
    variance += settings.hidden_variance;
  }
  const bool bracketed = offset == offset;
  if (!bracketed && settings.drop_range_ends) return NAN;
  return static_cast<float>(winner) + (bracketed && settings.sub_pixel ? offset : 0.0F);
}

/// A block to a row: the nearest of the winners that meet in a target pixel hides the others.
__global__ void finish_row(Plane<const std::int16_t> winner, Plane<std::int16_t> target_winner, Plane<float> disparity,
                           Plane<float> variance, FinishSettings settings) {
  int* projected = shared_memory<int>();
  const int v = static_cast<int>(blockIdx.x), width = winner.width;
  const int first = static_cast<int>(threadIdx.x), step = static_cast<int>(blockDim.x);
  const std::int16_t* winners = winner.row(v);
  std::int16_t* target = target_winner.row(v);
  for (int x = first; x < width; x += step) projected[x] = settings.project ? -1 : target[x];
  __syncthreads();
  if (settings.project) {
    for (int u = first; u < width; u += step) {
      if (winners[u] >= 0) atomicMax(&projected[u - winners[u]], static_cast<int>(winners[u]));
    }
    __syncthreads();
    for (int x = first; x < width; x += step) target[x] = static_cast<std::int16_t>(projected[x]);
  }
  float *disparities = disparity.row(v), *variances = variance.row(v);
  for (int u = first; u < width; u += step) {
    const int of_target = winners[u] >= 0 ? projected[u - winners[u]] : -1;
    disparities[u] = finish(winners[u], of_target, disparities[u], settings, variances[u]);
  }
}

}  // namespace

void finish_rows(Plane<const std::int16_t> winner, Plane<std::int16_t> target_winner, Plane<float> disparity,
                 Plane<float> variance, const FinishSettings& settings, cudaStream_t stream) {
  constexpr unsigned threads = 256;
  const std::size_t shared = sizeof(int) * static_cast<std::size_t>(winner.width);
  launch(finish_row, {static_cast<unsigned>(winner.height), threads, shared}, stream, winner, target_winner, disparity,
         variance, settings);
}

}  // namespace roadstereo::cuda
