#include "core/downsample.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/downsample.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {

/// Mean of factor × factor pixels; with a factor known to the compiler the loops are vectorised.
template <int known_factor>
void downsample_row(ImageView<const std::int16_t> image, int factor, int y, std::int16_t* small, int width) {
  const int n = known_factor > 0 ? known_factor : factor;
  for (int x = 0; x < width; ++x) {
    std::int32_t sum = 0;
    for (int r = 0; r < n; ++r) {
      const std::int16_t* from = image.row(y * n + r) + static_cast<std::ptrdiff_t>(x) * n;
      for (int c = 0; c < n; ++c) sum += from[c];
    }
    small[x] = static_cast<std::int16_t>(sum / (n * n));
  }
}

void downsample(ImageView<const std::int16_t> image, int factor, ImageView<std::int16_t> small) {
  for (int y = 0; y < small.height(); ++y) {
    switch (factor) {
      case 1:
        std::copy_n(image.row(y), small.width(), small.row(y));
        break;
      case 2:
        downsample_row<2>(image, factor, y, small.row(y), small.width());
        break;
      case 4:
        downsample_row<4>(image, factor, y, small.row(y), small.width());
        break;
      case 8:
        downsample_row<8>(image, factor, y, small.row(y), small.width());
        break;
      default:
        downsample_row<0>(image, factor, y, small.row(y), small.width());
    }
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(downsample);

void downsample(ImageView<const std::int16_t> image, int factor, ImageView<std::int16_t> small) {
  HWY_DYNAMIC_DISPATCH(downsample)(image, factor, small);
}

GreyImage downsample(ImageView<const std::int16_t> image, int factor) {
  GreyImage small(image.width() / factor, image.height() / factor);
  downsample(image, factor, small.view());
  return small;
}

}  // namespace roadstereo
#endif  // HWY_ONCE
