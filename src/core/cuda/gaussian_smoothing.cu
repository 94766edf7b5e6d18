// Floor: 8 bytes and twice 2·radius + 1 products a pixel, 1.8 MB for 640×360; only pairs with unequal blur need it. The
// pixels of a row are its neighbours' too, and come from the first cache.

#include "core/cuda/gaussian_smoothing.hpp"
#include "core/cuda/launch.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int row_threads = 128;

using Pixels = ImageView<std::int16_t>;

__global__ void smooth_rows(SmoothingKernel kernel, Pixels image, Pixels smoothed) {
  begin_kernel();
  const int u = static_cast<int>(blockIdx.x) * row_threads + static_cast<int>(threadIdx.x);
  const int v = static_cast<int>(blockIdx.y), width = image.width();
  if (u >= width) return;
  const std::int16_t* const row = image.row(v);
  smoothed(u, v) = smoothed_level(kernel, [=](int k) { return static_cast<int>(row[clamped_index(u + k, width)]); });
}

__global__ void smooth_columns(SmoothingKernel kernel, Pixels image, Pixels smoothed) {
  begin_kernel();
  const int u = static_cast<int>(blockIdx.x) * row_threads + static_cast<int>(threadIdx.x);
  const int v = static_cast<int>(blockIdx.y), height = image.height();
  if (u >= image.width()) return;
  smoothed(u, v) =
      smoothed_level(kernel, [=](int k) { return static_cast<int>(image(u, clamped_index(v + k, height))); });
}

}  // namespace

void smooth_image(const SmoothingKernel& kernel, ImageView<std::int16_t> image, ImageView<std::int16_t> between,
                  StreamView stream) {
  const LaunchShape shape{
      {blocks_for(image.width(), row_threads), static_cast<unsigned>(image.height())}, row_threads, 0};
  launch("smooth_rows", smooth_rows, shape, stream, kernel, image, between);
  launch("smooth_columns", smooth_columns, shape, stream, kernel, between, image);
}

}  // namespace roadstereo::cuda
