#include "roadstereo/lens_spots.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace roadstereo {
namespace {

constexpr int frames_to_judge = 20;  // a pixel of a moving picture is an extreme in all of them once in 10^13

constexpr int nearest = 4, near = 8;  // rings around a cell, cells off
constexpr int word_bits = 64;

/// Calls `visit(u, v)` for every set bit, and clears it unless that returns true.
template <class Visit>
void keep_bits(Image<std::uint64_t>& bits, Visit&& visit) {
  for (int v = 0; v < bits.height(); ++v) {
    std::uint64_t* const row = bits.row(v);
    for (int word = 0; word < bits.width(); ++word) {
      for (std::uint64_t left = row[word]; left != 0; left &= left - 1) {
        if (!visit(word * word_bits + std::countr_zero(left), v)) row[word] ^= left & -left;
      }
    }
  }
}

}  // namespace

void LensWatch::begin(int width, int height) {
  spots_ = {};
  deviation_.assign(levels_.mean().width(), levels_.mean().height(), 0);
  steady_.assign(deviation_.width(), deviation_.height(), 0);
  for (Extremes* const bits : {&brighter_, &darker_}) bits->assign((width + word_bits - 1) / word_bits, height, 0);
  pending_.reserve(steady_.pixels());
  width_ = width;
  height_ = height;
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
    keep_bits(brighter_, [&](int u, int v) { return brighter_by(u, v, 1) > margin; });
    keep_bits(darker_, [&](int u, int v) { return brighter_by(u, v, -1) > margin; });
    return;
  }
  for (Extremes* const bits : {&brighter_, &darker_}) bits->assign(bits->width(), height_, 0);
  for (int v = 1; v + 1 < height_; ++v) {
    for (int u = 1; u + 1 < width_; ++u) {
      const int before = grey(u, v) - grey(u - 1, v);
      if (std::abs(before) <= margin) continue;
      if (brighter_by(u, v, before > 0 ? 1 : -1) <= margin) continue;
      (before > 0 ? brighter_ : darker_)(u / word_bits, v) |= std::uint64_t{1} << (u % word_bits);
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
/// A spot has none where the ring around the cell lies outside it: the farthest ring is two fifths of the width across.
void LensWatch::find_steady_cells() {
  constexpr int rings_across = 5;
  const int farthest = std::max(near, deviation_.width() / rings_across);
  for (int y = 0; y < deviation_.height(); ++y) {
    for (int x = 0; x < deviation_.width(); ++x) deviation_(x, y) = std::sqrt(levels_.variance()(x, y));
  }
  for (int y = 1; y + 1 < steady_.height(); ++y) {
    for (int x = 1; x + 1 < steady_.width(); ++x) {
      int reach = nearest;
      while (reach < farthest && !stands_out(x, y, reach)) reach = std::min(2 * reach, farthest);
      const bool is_steady = reach < farthest || stands_out(x, y, farthest);
      steady_(x, y) = static_cast<std::uint8_t>(is_steady ? reach : 0);
    }
  }
}

/// Counts the connected components of steady cells and finds the centre of the largest. A small spot stands out near
/// by, in two cells; of one that does so only further off, an eighth of the square of that distance is steady.
void LensWatch::count_dirt() {
  constexpr std::size_t min_near = 2, cells_of_square = 8;
  std::size_t largest = 0;
  spots_.dirt = 0;
  const int columns = steady_.width();
  for (int start = 0; start < static_cast<int>(steady_.pixels()); ++start) {
    if (steady_(start % columns, start / columns) == 0) continue;
    double sum_u = 0, sum_v = 0;
    std::size_t near_cells = 0, reach = std::numeric_limits<std::uint8_t>::max();
    const auto take = [&](int x, int y) {
      const std::size_t cells_off = steady_(x, y);
      if (cells_off <= near) {
        ++near_cells;
      } else {
        reach = std::min(reach, cells_off);
      }
      steady_(x, y) = 0;
      pending_.push_back(y * columns + x);
    };
    pending_.clear();
    take(start % columns, start / columns);
    std::size_t done = 0;
    for (; done < pending_.size(); ++done) {
      const int u = pending_[done] % columns, v = pending_[done] / columns;
      sum_u += u;
      sum_v += v;
      for (int y = v - 1; y <= v + 1; ++y) {
        for (int x = u - 1; x <= u + 1; ++x) {  // never at the border
          if (steady_(x, y) != 0) take(x, y);
        }
      }
    }
    if (near_cells < min_near && done < reach * reach / cells_of_square) continue;
    ++spots_.dirt;
    if (done <= largest) continue;
    largest = done;
    const auto cells = static_cast<double>(done);
    spots_.largest_u = levels_.cell_px() * (sum_u / cells + 0.5);
    spots_.largest_v = levels_.cell_px() * (sum_v / cells + 0.5);
  }
}

/// Whether the levels change in the cell of a pixel and those around it: the texture of a bonnet is always the same.
bool LensWatch::is_moving(int u, int v) const {
  constexpr float min_deviation = 2 * grey_scale;
  for (const int dv : {-1, 0, 1}) {
    for (const int du : {-1, 0, 1}) {
      const int x = std::clamp(u / levels_.cell_px() + du, 0, deviation_.width() - 1);
      const int y = std::clamp(v / levels_.cell_px() + dv, 0, deviation_.height() - 1);
      if (deviation_(x, y) < min_deviation) return false;
    }
  }
  return true;
}

/// Counts them and, without dirt, keeps the place of the first one.
void LensWatch::count_dead_pixels() {
  std::size_t dead = 0;
  int first_u = width_, first_v = height_;
  for (Extremes* const bits : {&brighter_, &darker_}) {
    keep_bits(*bits, [&](int u, int v) {
      if (!is_moving(u, v)) return false;
      ++dead;
      if (v < first_v || (v == first_v && u < first_u)) {
        first_u = u;
        first_v = v;
      }
      return true;
    });
  }
  spots_.dead_pixels = static_cast<double>(dead);
  spots_.dead_share = spots_.dead_pixels / (1.0 * width_ * height_);
  if (spots_.dirt > 0 || dead == 0) return;
  spots_.largest_u = first_u;
  spots_.largest_v = first_v;
}

void LensWatch::add(ImageView<const std::int16_t> grey) {
  const bool starts = grey.width() != width_ || grey.height() != height_;
  if (starts) {
    width_ = height_ = 0;  // until there is memory
    levels_ = CellLevels(moving_share);
  }
  const bool counts = levels_.add(grey);
  if (starts) begin(grey.width(), grey.height());
  if (!counts) return;
  add_extremes(grey);
  if (levels_.frames() % frames_to_judge != 0) return;
  spots_ = {};
  find_steady_cells();
  count_dirt();
  count_dead_pixels();
}

}  // namespace roadstereo
