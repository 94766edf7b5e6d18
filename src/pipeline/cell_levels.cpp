#include "roadstereo/cell_levels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace roadstereo {

void CellLevels::begin(int width, int height) {
  constexpr int cells_across = 160;
  width_ = height_ = 0;  // until there is memory
  cell_px_ = std::max(1, width / cells_across);
  frames_ = 0;
  for (Image<float>* const cells : {&cells_, &last_, &mean_, &variance_}) {
    cells->assign(width / cell_px_, height / cell_px_, 0);
  }
  sums_.resize(static_cast<std::size_t>(width));
  width_ = width;
  height_ = height;
}

void CellLevels::average_cells(ImageView<const std::int16_t> grey) {
  constexpr int step = 2;  // rows
  const int rows = (cell_px_ + step - 1) / step;
  const float scale = 1 / static_cast<float>(rows * cell_px_);
  for (int y = 0; y < cells_.height(); ++y) {
    std::fill(sums_.begin(), sums_.end(), 0);
    for (int v = y * cell_px_; v < (y + 1) * cell_px_; v += step) {
      const std::int16_t* const level = grey.row(v);
      int* const sum = sums_.data();
      for (int u = 0; u < width_; ++u) sum[u] += level[u];
    }
    const int* of_cell = sums_.data();
    for (int x = 0; x < cells_.width(); ++x, of_cell += cell_px_) {
      cells_(x, y) = scale * static_cast<float>(std::accumulate(of_cell, of_cell + cell_px_, 0));
    }
  }
}

/// Whether enough cells have changed since the last frame that counted.
bool CellLevels::has_moved() const {
  constexpr float min_change = 2 * grey_scale;
  if (frames_ == 0) return true;
  std::size_t changed = 0;
  for (int y = 0; y < cells_.height(); ++y) {
    const float *now = cells_.row(y), *before = last_.row(y);
    for (int x = 0; x < cells_.width(); ++x) changed += std::abs(now[x] - before[x]) > min_change ? 1U : 0U;
  }
  return static_cast<double>(changed) > moving_share_ * static_cast<double>(cells_.pixels());
}

/// Mean and variance over the frames; old ones fade.
void CellLevels::add_levels() {
  constexpr int memory_frames = 100;
  const float weight = 1 / static_cast<float>(std::min(frames_, memory_frames));
  for (int y = 0; y < cells_.height(); ++y) {
    const float* const now = last_.row(y);
    float *const mean = mean_.row(y), *const variance = variance_.row(y);
    for (int x = 0; x < cells_.width(); ++x) {
      const float difference = now[x] - mean[x];
      mean[x] += weight * difference;
      variance[x] = (1 - weight) * (variance[x] + weight * difference * difference);
    }
  }
}

bool CellLevels::add(ImageView<const std::int16_t> grey) {
  if (grey.width() != width_ || grey.height() != height_) begin(grey.width(), grey.height());
  average_cells(grey);
  if (!has_moved()) return false;
  ++frames_;
  std::swap(cells_, last_);
  add_levels();
  return true;
}

}  // namespace roadstereo
