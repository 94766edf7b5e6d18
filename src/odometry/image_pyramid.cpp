#include "odometry/image_pyramid.hpp"

#include <algorithm>

#include "core/downsample.hpp"

namespace roadstereo {
namespace {

constexpr int max_levels = 5;
constexpr int min_side = 40;  // pixels; fewer hold no texture that a motion could be estimated from

/// Central differences; those of the border are 0.
void fill_samples(ImageView<const std::int16_t> grey, Image<GreySample>& samples) {
  constexpr float grey_unit = 1.0F / 16;
  const int width = grey.width(), height = grey.height();
  samples.resize(width, height);
  for (int v = 0; v < height; ++v) {
    const std::int16_t* row = grey.row(v);
    const std::int16_t* above = grey.row(std::max(v - 1, 0));
    const std::int16_t* below = grey.row(std::min(v + 1, height - 1));
    GreySample* out = samples.row(v);
    for (int u = 0; u < width; ++u) {
      const int before = row[std::max(u - 1, 0)], after = row[std::min(u + 1, width - 1)];
      out[u] = {static_cast<float>(row[u]) * grey_unit, static_cast<float>(after - before) * (grey_unit / 2),
                static_cast<float>(below[u] - above[u]) * (grey_unit / 2)};
    }
  }
}

int level_count(int width, int height) {
  int levels = 1;
  while (levels < max_levels && std::min(width, height) >> levels >= min_side) ++levels;
  return levels;
}

}  // namespace

void ImagePyramid::build(ImageView<const std::int16_t> grey) {
  levels_ = level_count(grey.width(), grey.height());
  samples_.resize(static_cast<std::size_t>(levels_));
  grey_.resize(static_cast<std::size_t>(levels_ - 1));
  fill_samples(grey, samples_[0]);
  ImageView<const std::int16_t> finer = grey;
  for (std::size_t n = 1; n < samples_.size(); ++n) {
    grey_[n - 1].resize(finer.width() / 2, finer.height() / 2);
    downsample(finer, 2, grey_[n - 1].view());
    finer = grey_[n - 1].view();
    fill_samples(finer, samples_[n]);
  }
}

}  // namespace roadstereo
