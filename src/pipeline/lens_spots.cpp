#include "roadstereo/lens_spots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace roadstereo {
namespace {

constexpr int frames_to_judge = 20;  // a pixel of a moving picture is an extreme in all of them once in 10^13
constexpr float grey_level = grey_max / 255.0F;

}  // namespace

void LensWatch::begin(int width, int height) {
  constexpr int cells_across = 160;
  width_ = width;
  height_ = height;
  cell_px_ = std::max(1, width / cells_across);
  frames_ = 0;
  spots_ = {};
  const int columns = width / cell_px_, rows = height / cell_px_;
  for (Image<float>* const cells : {&cells_, &last_, &mean_, &variance_, &deviation_}) cells->assign(columns, rows, 0);
  steady_.assign(columns, rows, 0);
  extremes_.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) / 2);
  sums_.resize(static_cast<std::size_t>(width));
  pending_.reserve(steady_.pixels());
}

void LensWatch::average_cells(ImageView<const std::int16_t> grey) {
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

/// Whether more than half of the cells have changed since the last frame that counted.
bool LensWatch::has_moved() {
  constexpr float min_change = 2 * grey_level;
  if (frames_ == 0) return true;
  std::size_t changed = 0;
  for (int y = 0; y < cells_.height(); ++y) {
    const float *now = cells_.row(y), *before = last_.row(y);
    for (int x = 0; x < cells_.width(); ++x) changed += std::abs(now[x] - before[x]) > min_change ? 1U : 0U;
  }
  return 2 * changed > cells_.pixels();
}

/// Mean and variance over the frames; old ones fade.
void LensWatch::add_levels() {
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

/// Keeps the pixels that are brighter, or darker, than their four neighbours in this frame, too.
void LensWatch::add_extremes(ImageView<const std::int16_t> grey) {
  constexpr int margin = static_cast<int>(8 * grey_level);
  const auto brighter_by = [&](int u, int v, int sign) {
    const int level = sign * grey(u, v);
    const int across = std::min(level - sign * grey(u - 1, v), level - sign * grey(u + 1, v));
    return std::min({across, level - sign * grey(u, v - 1), level - sign * grey(u, v + 1)});
  };
  if (frames_ % frames_to_judge != 1) {
    std::erase_if(extremes_, [&](const Extreme& one) { return brighter_by(one.u, one.v, one.sign) <= margin; });
    return;
  }
  extremes_.clear();
  for (int v = 1; v + 1 < height_; ++v) {
    for (int u = 1; u + 1 < width_; ++u) {
      const int before = grey(u, v) - grey(u - 1, v);
      if (std::abs(before) <= margin) continue;
      const int sign = before > 0 ? 1 : -1;
      if (brighter_by(u, v, sign) > margin) extremes_.push_back({u, v, sign});
    }
  }
}

/// Whether the levels vary much less in a cell than all around it, `reach` cells off, and differ from theirs by more
/// than they vary.
bool LensWatch::stands_out(int x, int y, int reach) const {
  constexpr float max_ratio = 0.5F, min_deviation = 2 * grey_level;
  const float limit = std::max(deviation_(x, y) / max_ratio, min_deviation);
  float contrast = 0, deviation = 0;
  const auto varies = [&](int u, int v) {
    const int column = std::clamp(u, 0, steady_.width() - 1), row = std::clamp(v, 0, steady_.height() - 1);
    const float around = deviation_(column, row);
    deviation += around;
    contrast += mean_(column, row) - mean_(x, y);
    return around > limit;
  };
  for (int i = -reach; i < reach; ++i) {
    if (!varies(x + i, y - reach) || !varies(x + reach, y + i) || !varies(x - i, y + reach) ||
        !varies(x - reach, y - i))
      return false;
  }
  return std::abs(contrast) > deviation;
}

/// The sky, a bonnet, a line along the road and the point that the vehicle drives to have neighbours like themselves.
void LensWatch::find_steady_cells() {
  constexpr std::array reaches{4, 8};
  for (int y = 0; y < deviation_.height(); ++y) {
    for (int x = 0; x < deviation_.width(); ++x) deviation_(x, y) = std::sqrt(variance_(x, y));
  }
  for (int y = 1; y + 1 < steady_.height(); ++y) {
    for (int x = 1; x + 1 < steady_.width(); ++x) {
      const bool is_steady =
          std::any_of(reaches.begin(), reaches.end(), [&](int reach) { return stands_out(x, y, reach); });
      steady_(x, y) = is_steady ? 1 : 0;
    }
  }
}

/// Counts the connected components of steady cells and finds the centre of the largest.
void LensWatch::count_dirt() {
  constexpr std::size_t min_cells = 2;
  std::size_t largest = 0;
  spots_.dirt = 0;
  const int columns = steady_.width();
  for (int start = 0; start < static_cast<int>(steady_.pixels()); ++start) {
    if (steady_(start % columns, start / columns) == 0) continue;
    double sum_u = 0, sum_v = 0;
    pending_.assign(1, start);
    steady_(start % columns, start / columns) = 0;
    std::size_t done = 0;
    for (; done < pending_.size(); ++done) {
      const int u = pending_[done] % columns, v = pending_[done] / columns;
      sum_u += u;
      sum_v += v;
      for (int y = v - 1; y <= v + 1; ++y) {
        for (int x = u - 1; x <= u + 1; ++x) {  // never at the border
          if (steady_(x, y) == 0) continue;
          steady_(x, y) = 0;
          pending_.push_back(y * columns + x);
        }
      }
    }
    if (done < min_cells) continue;
    ++spots_.dirt;
    if (done <= largest) continue;
    largest = done;
    const auto cells = static_cast<double>(done);
    spots_.largest_u = cell_px_ * (sum_u / cells + 0.5);
    spots_.largest_v = cell_px_ * (sum_v / cells + 0.5);
  }
}

/// Only where the picture changes: the texture of a bonnet is always the same.
void LensWatch::count_dead_pixels() {
  constexpr float min_deviation = 2 * grey_level;
  std::erase_if(extremes_, [&](const Extreme& one) {
    for (const int dv : {-1, 0, 1}) {
      for (const int du : {-1, 0, 1}) {
        const int x = std::clamp(one.u / cell_px_ + du, 0, deviation_.width() - 1);
        const int y = std::clamp(one.v / cell_px_ + dv, 0, deviation_.height() - 1);
        if (deviation_(x, y) < min_deviation) return true;
      }
    }
    return false;
  });
  spots_.dead_pixels = static_cast<double>(extremes_.size());
  spots_.dead_share = spots_.dead_pixels / (1.0 * width_ * height_);
  if (spots_.dirt > 0 || extremes_.empty()) return;
  spots_.largest_u = extremes_.front().u;
  spots_.largest_v = extremes_.front().v;
}

void LensWatch::add(ImageView<const std::int16_t> grey) {
  if (grey.width() != width_ || grey.height() != height_) begin(grey.width(), grey.height());
  average_cells(grey);
  if (!has_moved()) return;
  ++frames_;
  std::swap(cells_, last_);
  add_levels();
  add_extremes(grey);
  if (frames_ % frames_to_judge != 0) return;
  spots_ = {};
  find_steady_cells();
  count_dirt();
  count_dead_pixels();
}

}  // namespace roadstereo
