// Floor: 24 bytes and 20 operations a coarse pixel: 1.4 MB for 320×180.

#include <cmath>

#include "core/cuda/launch.hpp"
#include "stereo/coarse/cuda/coarse_map.hpp"
#include "stereo/coarse/map_pixel.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int threads = 128;

/// One row of the map and what lies nearest on each of its target columns.
struct MapRow {
  float* disparity;
  int* nearest;  ///< disparities as bits: those of positive floats are in their order
  int columns;

  __device__ bool occluded(int u) const {
    const float own = disparity[u];
    return own == own && is_occluded(own, __int_as_float(nearest[target_column(u, own)]));
  }

  /// Disparity of pixel u; where it is occluded, that of the farther neighbour of its run.
  __device__ float corrected(int u) const {
    if (!occluded(u)) return disparity[u];
    int first = u, end = u + 1;
    while (first > 0 && occluded(first - 1)) --first;
    while (end < columns && occluded(end)) ++end;
    const float before = first > 0 ? disparity[first - 1] : disparity[end < columns ? end : columns - 1];
    const float after = end < columns ? disparity[end] : before;
    return fminf(before, after);  // the one that is known, when one is not
  }
};

__device__ float median_at(const ImageView<const float>& map, int u, int v) {
  const auto at = [&](int row) { return __ldg(&map(u, row < 0 ? 0 : row < map.height() ? row : map.height() - 1)); };
  return median_of_rows(at(v - 2), at(v - 1), at(v), at(v + 1), at(v + 2));
}

__global__ void correct_row(ImageView<const float> along_rows, float factor, ImageView<float> prior) {
  begin_kernel();
  const int v = static_cast<int>(blockIdx.x), columns = along_rows.width();
  auto* disparity = shared_memory<float>();
  const MapRow row{disparity, reinterpret_cast<int*>(disparity + columns), columns};
  const auto thread = static_cast<int>(threadIdx.x);
  for (int u = thread; u < columns; u += threads) row.nearest[u] = 0;
  __syncthreads();
  for (int u = thread; u < columns; u += threads) {
    const float own = median_at(along_rows, u, v);
    row.disparity[u] = own;
    if (own == own) atomicMax(&row.nearest[target_column(u, own)], __float_as_int(own));
  }
  __syncthreads();
  for (int u = thread; u < columns; u += threads) prior(u, v) = row.corrected(u) * factor;
}

}  // namespace

void correct_rows(ImageView<const float> along_rows, int factor, ImageView<float> prior, StreamView stream) {
  const std::size_t bytes = static_cast<std::size_t>(along_rows.width()) * (sizeof(float) + sizeof(int));
  launch("correct_row", correct_row, {static_cast<unsigned>(along_rows.height()), threads, bytes}, stream, along_rows,
         static_cast<float>(factor), prior);
}

}  // namespace roadstereo::cuda
