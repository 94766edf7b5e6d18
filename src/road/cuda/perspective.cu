// Floor of transform_target: 4 bytes and about 20 operations a pixel, of which six in double precision: 0.9 MB for
// 640×360. The four samples of a pixel are its neighbours' too, and come from the first cache.
// Floor of restore_disparity: 8 bytes and 4 operations a pixel.

#include "core/cuda/launch.hpp"
#include "road/cubic.hpp"
#include "road/cuda/perspective.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int row_threads = 128;

/// Samples along one row of the target, which lies between its rows where it has an offset.
struct SampledRow {
  const std::int16_t *before, *at, *after, *beyond;
  CubicWeights weights;
  bool between;
  int last;  ///< column; beyond it and before the first one the border goes on

  __device__ float operator()(int u) const {
    const int x = u < 0 ? 0 : u > last ? last : u;
    if (!between) return static_cast<float>(__ldg(at + x));
    return weighted(weights, static_cast<float>(__ldg(before + x)), static_cast<float>(__ldg(at + x)),
                    static_cast<float>(__ldg(after + x)), static_cast<float>(__ldg(beyond + x)));
  }
};

__device__ SampledRow sampled_row(const ImageView<const std::int16_t>& image, double v) {
  const double whole = floor(v);
  const auto row = [&](int below) {
    const int wanted = static_cast<int>(whole) + below;
    return image.row(wanted < 0 ? 0 : wanted >= image.height() ? image.height() - 1 : wanted);
  };
  return {row(-1), row(0), row(1), row(2), cubic_weights(v - whole), v != whole, image.width() - 1};
}

__device__ std::int16_t shifted_grey(const SampledRow& row, const PerspectiveShift& shift, int x, int v, float white) {
  const double by = shift.at(x, v);
  const int whole = static_cast<int>(ceil(by));
  const auto f = static_cast<float>(whole - by);
  const int source = x - whole;
  return grey_between(row(source - 1), row(source), row(source + 1), row(source + 2), f, white);
}

__global__ void transform_rows(ImageView<const std::int16_t> target, PerspectiveShift shift, float white,
                               ImageView<std::int16_t> transformed, int* first_column) {
  int* first = shared_memory<int>();
  const int v = static_cast<int>(blockIdx.y);
  if (threadIdx.x == 0) {
    *first = find_first_column(shift, v, target.width());
    if (blockIdx.x == 0) first_column[v] = *first;
  }
  __syncthreads();
  const int x = static_cast<int>(blockIdx.x) * row_threads + static_cast<int>(threadIdx.x);
  if (x >= target.width()) return;
  const SampledRow row = sampled_row(target, v + shift.row_offset);
  transformed(x, v) = x < *first ? std::int16_t{0} : shifted_grey(row, shift, x, v, white);
}

__global__ void restore_rows(ImageView<const float> residual, PerspectiveShift shift, ImageView<float> disparity) {
  const int u = static_cast<int>(blockIdx.x) * row_threads + static_cast<int>(threadIdx.x);
  const int v = static_cast<int>(blockIdx.y);
  if (u >= residual.width()) return;
  const float own = residual(u, v);
  disparity(u, v) = !shift.enabled      ? own
                    : shift.whole_pixel ? with_whole_shift(own, shift, u, v)
                                        : with_shift(own, row_line(shift.road, v, shift.delta_p), u);
}

dim3 row_blocks(int width, int height) {
  return {blocks_for(width, row_threads), static_cast<unsigned>(height)};
}

}  // namespace

void transform_target(ImageView<const std::int16_t> target, const PerspectiveShift& shift, float white,
                      ImageView<std::int16_t> transformed, int* first_column, cudaStream_t stream) {
  launch(transform_rows, {row_blocks(target.width(), target.height()), row_threads, sizeof(int)}, stream, target, shift,
         white, transformed, first_column);
}

void restore_disparity(ImageView<const float> residual, const PerspectiveShift& shift, ImageView<float> disparity,
                       cudaStream_t stream) {
  launch(restore_rows, {row_blocks(residual.width(), residual.height()), row_threads}, stream, residual, shift,
         disparity);
}

}  // namespace roadstereo::cuda
