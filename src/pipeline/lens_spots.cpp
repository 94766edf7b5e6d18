#include "roadstereo/lens_spots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace roadstereo {
namespace {

constexpr int frames_to_judge = 20;  // a pixel of a moving picture is an extreme in all of them once in 10^13

}  // namespace

void LensWatch::begin(int width, int height) {
  width_ = width;
  height_ = height;
  spots_ = {};
  deviation_.assign(levels_.mean().width(), levels_.mean().height(), 0);
  steady_.assign(deviation_.width(), deviation_.height(), 0);
  extremes_.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) / 2);
  pending_.reserve(steady_.pixels());
}

/// Keeps the pixels that are brighter, or darker, than their four neighbours in this frame, too.
void LensWatch::add_extremes(ImageView<const std::int16_t> grey) {
  constexpr int margin = 8 * grey_scale;
  const auto brighter_by = [&](int u, int v, int sign) {
    const int level = sign * grey(u, v);
    const int across = std::min(level - sign * grey(u - 1, v), level - sign * grey(u + 1, v));
    return std::min({across, level - sign * grey(u, v - 1), level - sign * grey(u, v + 1)});
  };
  if (levels_.frames() % frames_to_judge != 1) {
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
  constexpr float max_ratio = 0.5F, min_deviation = 2 * grey_scale;
  const float limit = std::max(deviation_(x, y) / max_ratio, min_deviation);
  float contrast = 0, deviation = 0;
  const auto varies = [&](int u, int v) {
    const int column = std::clamp(u, 0, steady_.width() - 1), row = std::clamp(v, 0, steady_.height() - 1);
    const float around = deviation_(column, row);
    deviation += around;
    contrast += levels_.mean()(column, row) - levels_.mean()(x, y);
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
    for (int x = 0; x < deviation_.width(); ++x) deviation_(x, y) = std::sqrt(levels_.variance()(x, y));
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
    spots_.largest_u = levels_.cell_px() * (sum_u / cells + 0.5);
    spots_.largest_v = levels_.cell_px() * (sum_v / cells + 0.5);
  }
}

/// Only where the picture changes: the texture of a bonnet is always the same.
void LensWatch::count_dead_pixels() {
  constexpr float min_deviation = 2 * grey_scale;
  std::erase_if(extremes_, [&](const Extreme& one) {
    for (const int dv : {-1, 0, 1}) {
      for (const int du : {-1, 0, 1}) {
        const int x = std::clamp(one.u / levels_.cell_px() + du, 0, deviation_.width() - 1);
        const int y = std::clamp(one.v / levels_.cell_px() + dv, 0, deviation_.height() - 1);
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
  const bool counts = levels_.add(grey);
  if (grey.width() != width_ || grey.height() != height_) begin(grey.width(), grey.height());
  if (!counts) return;
  add_extremes(grey);
  if (levels_.frames() % frames_to_judge != 0) return;
  spots_ = {};
  find_steady_cells();
  count_dirt();
  count_dead_pixels();
}

}  // namespace roadstereo
