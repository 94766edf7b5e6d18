#include "damage/cell_interpolation.hpp"

#include <algorithm>

namespace roadstereo {

LinearTaps linear_taps(int pixel, int factor, int count) {
  const float half = 0.5F * static_cast<float>(factor - 1);
  const float x =
      std::clamp((static_cast<float>(pixel) - half) / static_cast<float>(factor), 0.0F, static_cast<float>(count - 1));
  const int first = static_cast<int>(x);
  const float weight = x - static_cast<float>(first);
  return {first, weight > 0 ? first + 1 : first, weight};
}

float interpolate_bilinear(const Image<float>& cells, int factor, int u, int v) {
  const auto [left, right, s] = linear_taps(u, factor, cells.width());
  const auto [above, below, t] = linear_taps(v, factor, cells.height());
  return (1 - t) * ((1 - s) * cells(left, above) + s * cells(right, above)) +
         t * ((1 - s) * cells(left, below) + s * cells(right, below));
}

RowUpsampler::RowUpsampler(const Image<float>& cells, int factor, int width) : cells_(cells), factor_(factor) {
  columns_.reserve(static_cast<std::size_t>(width));
  for (int u = 0; u < width; ++u) columns_.push_back(linear_taps(u, factor, cells.width()));
}

void RowUpsampler::interpolate_row(int row, InterpolatedRow& result) const {
  if (result.row == row) return;
  result.row = row;
  result.values.resize(columns_.size());
  const float* const cells = cells_.row(row);
  for (std::size_t u = 0; u < columns_.size(); ++u) {
    const auto& [left, right, weight] = columns_[u];
    result.values[u] = (1 - weight) * cells[left] + weight * cells[right];
  }
}

void RowUpsampler::read(int v, float* values) {
  const auto [above, below, weight] = linear_taps(v, factor_, cells_.height());
  if (below_.row == above) std::swap(above_, below_);
  interpolate_row(above, above_);
  if (below == above) {
    std::copy(above_.values.begin(), above_.values.end(), values);
    return;
  }
  interpolate_row(below, below_);
  const float* const one = above_.values.data();
  const float* const other = below_.values.data();
  const auto width = static_cast<int>(columns_.size());
  for (int u = 0; u < width; ++u) values[u] = (1 - weight) * one[u] + weight * other[u];
}

}  // namespace roadstereo
