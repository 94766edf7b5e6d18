#include "damage/image_outline.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/median.hpp"

namespace roadstereo {
namespace {

/// Median of grey levels and their robust standard deviation: a sunlit wall does not make a dark hole grey.
struct Tone {
  double middle = 0;
  double deviation = 0;
  std::size_t cells = 0;
};

/// Of the cells that are `inside` and not `without`.
Tone tone_of(const Image<float>& grey, const Image<std::uint8_t>& inside, const Image<std::uint8_t>* without,
             const Box& box) {
  std::vector<float> values;
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (inside(i, j) != 0 && (without == nullptr || (*without)(i, j) == 0)) values.push_back(grey(i, j));
    }
  }
  if (values.empty()) return {};
  const float middle = take_median(values);
  for (float& value : values) value = std::abs(value - middle);
  return {middle, gaussian_mad * take_median(values), values.size()};
}

/// Grey level between two tones at which both are as likely: each as many deviations away.
double border_between(const Tone& one, const Tone& other) {
  return (one.middle * other.deviation + other.middle * one.deviation) / (one.deviation + other.deviation);
}

/// Mean of 3×3 cells: single stones are no edge.
Image<float> smoothed(const Image<float>& grey, const Box& box) {
  Image<float> result = grey;
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      float sum = 0;
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
          sum += grey(std::clamp(i + di, 0, grey.width() - 1), std::clamp(j + dj, 0, grey.height() - 1));
        }
      }
      result(i, j) = sum / 9;
    }
  }
  return result;
}

}  // namespace

void extend_by_image(const Image<float>& grey, int reach, const Box& box, Image<std::uint8_t>& region) {
  constexpr double least_difference = 1.5;  // standard deviations
  constexpr std::size_t least_cells = 30;
  const Box around = box.grown(3 * reach, region.width(), region.height());
  const Image<float> tones = smoothed(grey, around);
  const Image<std::uint8_t> band = grow(region, reach, around);
  const Image<std::uint8_t> beyond = grow(region, 3 * reach, around);
  const Tone inside = tone_of(tones, shrink_mask(region, 2, around), nullptr, around);
  const Tone outside = tone_of(tones, beyond, &band, around);
  if (inside.cells < least_cells || outside.cells < least_cells) return;
  const double spread = std::sqrt(0.5 * (inside.deviation * inside.deviation + outside.deviation * outside.deviation));
  if (std::abs(inside.middle - outside.middle) < least_difference * spread || spread == 0) return;
  const double border = border_between(inside, outside);
  const bool dark = inside.middle < outside.middle;
  std::vector<std::int32_t> open;
  const auto take = [&](int i, int j) {
    if (i < 0 || j < 0 || i >= region.width() || j >= region.height()) return;
    if (region(i, j) != 0 || band(i, j) == 0 || (tones(i, j) < border) != dark) return;
    region(i, j) = 255;
    open.push_back(j * region.width() + i);
  };
  const Image<std::uint8_t> start = region;
  for (int j = box.first_row; j <= box.last_row; ++j) {
    for (int i = box.first_column; i <= box.last_column; ++i) {
      if (start(i, j) == 0) continue;
      take(i - 1, j);
      take(i + 1, j);
      take(i, j - 1);
      take(i, j + 1);
    }
  }
  while (!open.empty()) {
    const int i = open.back() % region.width();
    const int j = open.back() / region.width();
    open.pop_back();
    take(i - 1, j);
    take(i + 1, j);
    take(i, j - 1);
    take(i, j + 1);
  }
}

}  // namespace roadstereo
