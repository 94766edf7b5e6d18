#include "evaluate/lane.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo::cli {
namespace {

constexpr int block_radius = 5;

/// Squared central differences.
template <class Difference>
Image<float> squares_of(int width, int height, const Difference& difference) {
  Image<float> squares(width, height, 0);
  for (int v = 1; v + 1 < height; ++v) {
    for (int u = 1; u + 1 < width; ++u) {
      const auto one = static_cast<float>(difference(u, v));
      squares(u, v) = one * one;
    }
  }
  return squares;
}

/// Sums over blocks, clipped to the image: first along the columns, then along the rows.
Image<float> block_sums(const Image<float>& values) {
  const int width = values.width();
  const int height = values.height();
  Image<float> columns(width, height, 0);
  Image<float> sums(width, height, 0);
  for (int v = 0; v < height; ++v) {
    for (int y = std::max(0, v - block_radius); y <= std::min(height - 1, v + block_radius); ++y) {
      for (int u = 0; u < width; ++u) columns(u, v) += values(u, y);
    }
    for (int u = 0; u < width; ++u) {
      for (int x = std::max(0, u - block_radius); x <= std::min(width - 1, u + block_radius); ++x) {
        sums(u, v) += columns(x, v);
      }
    }
  }
  return sums;
}

}  // namespace

Image<std::uint8_t> lane_mask(ImageView<const float> truth, ImageView<const std::uint8_t> road,
                              const StereoCalibration& calibration) {
  Image<std::uint8_t> mask(truth.width(), truth.height(), 0);
  for (int v = 0; v < truth.height(); ++v) {
    for (int u = 0; u < truth.width(); ++u) {
      if (road(u, v) == 0 || !std::isfinite(truth(u, v))) continue;
      const auto [x, y, z] = calibration.point_m(u, v, double{truth(u, v)});
      if (std::abs(x) < lane_half_width_m && z < lane_length_m) mask(u, v) = 255;
    }
  }
  return mask;
}

Image<std::uint8_t> edges_along_rows(const GreyImage& grey) {
  constexpr float min_ratio = 4;
  const int width = grey.width();
  const int height = grey.height();
  const Image<float> across =
      block_sums(squares_of(width, height, [&](int u, int v) { return grey(u + 1, v) - grey(u - 1, v); }));
  const Image<float> down =
      block_sums(squares_of(width, height, [&](int u, int v) { return grey(u, v + 1) - grey(u, v - 1); }));
  Image<std::uint8_t> edges(width, height, 0);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const bool edge = down(u, v) > 0 && down(u, v) >= min_ratio * min_ratio * across(u, v);
      if (edge) edges(u, v) = 255;
    }
  }
  return edges;
}

void exclude(ImageView<const std::uint8_t> excluded, Image<std::uint8_t>& mask) {
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      if (excluded(u, v) != 0) mask(u, v) = 0;
    }
  }
}

}  // namespace roadstereo::cli
