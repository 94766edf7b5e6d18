#include "core/cuda/launch.hpp"
#include "road/refinement/between_pixels.hpp"
#include "road/refinement/cuda/interpolation.hpp"

// A thread writes the four pixels from one that was matched on. Floor: 2 bytes read and 8 written a pixel: 2.3 MB at
// 640×360, 0.5 µs of an H200's 4.8 TB/s.

namespace roadstereo::cuda {
namespace {

constexpr int block_columns = 32, block_rows = 8;

/// The matched pixels, and the full maps.
struct Maps {
  ImageView<const float> disparity, sigma;
  ImageView<float> full, full_sigma;
  float across, down;  ///< the road's disparity grows by so much from a pixel to the next

  __device__ RefinedPixel matched(int x, int y) const { return {__ldg(&disparity(x, y)), __ldg(&sigma(x, y))}; }

  /// Halfway to the next matched pixel of the row; behind the last one its height continues.
  __device__ RefinedPixel between_columns(const RefinedPixel& own, int x, int y) const {
    if (x + 1 == disparity.width()) return {own.disparity + across, own.error};
    return between_pixels(own, matched(x + 1, y), across);
  }

  __device__ void write(int u, int v, const RefinedPixel& pixel) const {
    if (u >= full.width()) return;
    full(u, v) = pixel.disparity;
    full_sigma(u, v) = pixel.error;
  }
};

__global__ void interpolate_four(Maps maps) {
  begin_kernel();
  const int x = static_cast<int>(blockIdx.x * block_columns + threadIdx.x);
  const int y = static_cast<int>(blockIdx.y * block_rows + threadIdx.y);
  if (x >= maps.disparity.width() || y >= maps.disparity.height()) return;
  const int u = 2 * x, v = 2 * y;
  const RefinedPixel own = maps.matched(x, y), right = maps.between_columns(own, x, y);
  maps.write(u, v, own);
  maps.write(u + 1, v, right);
  if (v + 1 >= maps.full.height()) return;
  if (y + 1 == maps.disparity.height()) {
    maps.write(u, v + 1, {own.disparity + maps.down, own.error});
    maps.write(u + 1, v + 1, {right.disparity + maps.down, right.error});
    return;
  }
  const RefinedPixel below = maps.matched(x, y + 1);
  maps.write(u, v + 1, between_pixels(own, below, maps.down));
  maps.write(u + 1, v + 1, between_pixels(right, maps.between_columns(below, x, y + 1), maps.down));
}

}  // namespace

void interpolate_disparities(ImageView<const float> disparity, ImageView<const float> sigma, const DisparityPlane& road,
                             ImageView<float> full, ImageView<float> full_sigma, StreamView stream) {
  const Maps maps{disparity, sigma, full, full_sigma, static_cast<float>(road.a2), static_cast<float>(road.a1)};
  launch("interpolate_four", interpolate_four,
         {dim3(blocks_for(disparity.width(), block_columns), blocks_for(disparity.height(), block_rows)),
          dim3(block_columns, block_rows)},
         stream, maps);
}

}  // namespace roadstereo::cuda
