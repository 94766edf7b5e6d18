// Floor: 2 + 2 / factor² bytes and one addition a pixel: 0.6 MB for 640×360 at half size.

#include "core/cuda/downsample.hpp"
#include "core/cuda/launch.hpp"

namespace roadstereo::cuda {
namespace {

constexpr int block_columns = 64, block_rows = 4;

struct Shrinking {
  ImageView<const std::int16_t> image;
  ImageView<std::int16_t> small;
};

/// A factor known to the compiler makes the loops straight; 0 is any other.
template <int known_factor>
__global__ void downsample_images(Shrinking first, Shrinking second, int factor) {
  begin_kernel();
  const Shrinking of = blockIdx.z == 0 ? first : second;
  const int x = static_cast<int>(blockIdx.x * block_columns + threadIdx.x);
  const int y = static_cast<int>(blockIdx.y * block_rows + threadIdx.y);
  if (x >= of.small.width() || y >= of.small.height()) return;
  const int n = known_factor > 0 ? known_factor : factor;
  int sum = 0;
  for (int r = 0; r < n; ++r) {
    const std::int16_t* from = of.image.row(y * n + r) + static_cast<std::ptrdiff_t>(x) * n;
    for (int c = 0; c < n; ++c) sum += __ldg(from + c);
  }
  of.small(x, y) = static_cast<std::int16_t>(sum / (n * n));
}

void downsample_all(const Shrinking& first, const Shrinking& second, unsigned images, int factor, StreamView stream) {
  const LaunchShape shape{
      dim3(blocks_for(first.small.width(), block_columns), blocks_for(first.small.height(), block_rows), images),
      dim3(block_columns, block_rows)};
  switch (factor) {
    case 2:
      return launch("downsample_images", downsample_images<2>, shape, stream, first, second, factor);
    case 4:
      return launch("downsample_images", downsample_images<4>, shape, stream, first, second, factor);
    case 8:
      return launch("downsample_images", downsample_images<8>, shape, stream, first, second, factor);
    default:
      return launch("downsample_images", downsample_images<0>, shape, stream, first, second, factor);
  }
}

}  // namespace

void downsample(ImageView<const std::int16_t> image, int factor, ImageView<std::int16_t> small, StreamView stream) {
  downsample_all({image, small}, {image, small}, 1, factor, stream);
}

void downsample(ImageView<const std::int16_t> first, ImageView<const std::int16_t> second, int factor,
                ImageView<std::int16_t> first_small, ImageView<std::int16_t> second_small, StreamView stream) {
  downsample_all({first, first_small}, {second, second_small}, 2, factor, stream);
}

}  // namespace roadstereo::cuda
