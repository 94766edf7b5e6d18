#include "damage/cell_interpolation.hpp"

#include <algorithm>

namespace roadstereo {

RowUpsampler::RowUpsampler(const Image<float>& cells, int factor, int width)
    : cells_(cells), factor_(factor), width_(width) {}

void RowUpsampler::interpolate_row(int row, InterpolatedRow& result) const {
  if (result.row == row) return;
  result.row = row;
  result.values.resize(static_cast<std::size_t>(width_));
  const float* const cells = cells_.row(row);
  float* const values = result.values.data();
  const auto interpolate = [&](int u) {
    const auto [left, right, weight] = linear_taps(u, factor_, cells_.width());
    values[u] = (1 - weight) * cells[left] + weight * cells[right];
  };
  // Away from the border every cell has the same weights.
  const int whole = std::min(width_ / factor_, cells_.width()) - 1;
  const int first = std::min(factor_, width_), last = std::max(first, whole * factor_);
  if (factor_ == 2) {  // of most images; both pixels of a cell together are a loop of vectors
    for (int i = 0; i + 1 < whole; ++i) {
      values[2 * i + 2] = 0.25F * cells[i] + 0.75F * cells[i + 1];
      values[2 * i + 3] = 0.75F * cells[i + 1] + 0.25F * cells[i + 2];
    }
  } else {
    for (int k = 0; k < factor_ && whole > 1; ++k) {
      const auto [left, right, weight] = linear_taps(factor_ + k, factor_, cells_.width());
      const float *const one = cells + left, *const other = cells + right;
      for (int i = 0; i + 1 < whole; ++i) {
        values[factor_ + k + i * factor_] = (1 - weight) * one[i] + weight * other[i];
      }
    }
  }
  for (int u = 0; u < first; ++u) interpolate(u);
  for (int u = last; u < width_; ++u) interpolate(u);
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
  for (int u = 0; u < width_; ++u) values[u] = (1 - weight) * one[u] + weight * other[u];
}

}  // namespace roadstereo
