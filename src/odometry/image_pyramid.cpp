#include "odometry/image_pyramid.hpp"

#include <algorithm>

#include "core/downsample.hpp"

namespace roadstereo {
namespace {

constexpr int max_levels = 5;
constexpr int min_side = 40;  // pixels; fewer hold no texture that a motion could be estimated from

int level_count(int width, int height) {
  int levels = 1;
  while (levels < max_levels && std::min(width, height) >> levels >= min_side) ++levels;
  return levels;
}

}  // namespace

void ImagePyramid::build(ImageView<const std::int16_t> grey) {
  grey_ = grey;
  reduced_.resize(static_cast<std::size_t>(level_count(grey.width(), grey.height()) - 1));
  for (GreyImage& reduced : reduced_) {
    reduced.resize(grey.width() / 2, grey.height() / 2);
    downsample(grey, 2, reduced.view());
    grey = reduced.view();
  }
}

}  // namespace roadstereo
