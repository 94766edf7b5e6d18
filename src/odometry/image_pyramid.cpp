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

bool sample_grey(ImageView<const std::int16_t> level, double x, double y, GreySample& sample) {
  constexpr int margin = 1;
  if (!(x >= margin && y >= margin && x < level.width() - 1 - margin && y < level.height() - 1 - margin)) return false;
  const int u = static_cast<int>(x), v = static_cast<int>(y);
  const float fu = static_cast<float>(x - u), fv = static_cast<float>(y - v);
  const std::int16_t* above = level.row(v - 1) + u;
  const std::int16_t* a = level.row(v) + u;
  const std::int16_t* b = level.row(v + 1) + u;
  const std::int16_t* below = level.row(v + 2) + u;
  const auto between = [fu, fv](int a0, int a1, int b0, int b1) {
    return (1 - fu) * (1 - fv) * static_cast<float>(a0) + fu * (1 - fv) * static_cast<float>(a1) +
           (1 - fu) * fv * static_cast<float>(b0) + fu * fv * static_cast<float>(b1);
  };
  sample.grey = between(a[0], a[1], b[0], b[1]) * grey_unit;
  sample.per_column = between(a[1] - a[-1], a[2] - a[0], b[1] - b[-1], b[2] - b[0]) * (grey_unit / 2);
  sample.per_row = between(b[0] - above[0], b[1] - above[1], below[0] - a[0], below[1] - a[1]) * (grey_unit / 2);
  return true;
}

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
