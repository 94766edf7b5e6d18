#pragma once

#include <cmath>
#include <cstdint>

#include "roadstereo/host_device.hpp"
#include "roadstereo/search_range.hpp"

namespace roadstereo {

/// First and last tile that a coarse column or row belongs to: pixels near a border count in both.
struct TileSpan {
  int first, last;
};

ROADSTEREO_HD inline int tile_at(int at, int size, int count) {
  const int tile = at / size;
  return tile < 0 ? 0 : tile >= count ? count - 1 : tile;
}

/// Coarse pixels of the neighbouring tiles that count too.
constexpr int tile_overlap = 2;

ROADSTEREO_HD inline TileSpan tiles_of(int at, int size, int count) {
  return {tile_at(at - tile_overlap, size, count), tile_at(at + tile_overlap, size, count)};
}

/// Where a disparity (full-size pixels) is counted.
ROADSTEREO_HD inline int disparity_bin(float disparity, int bins) {
  const float nearest = disparity + 0.5F;
  const int bin = nearest > 0.0F ? static_cast<int>(nearest) : 0;
  return bin < bins ? bin : bins - 1;
}

/// Target column, coarse pixels, of a disparity in full-size pixels, at least −½ coarse pixel.
ROADSTEREO_HD inline int tile_target_column(int u, float disparity, float inverse_factor) {
  // lround would keep loops from being vectorised.
  return u - static_cast<int>(disparity * inverse_factor + 0.5F);  // NOLINT(bugprone-incorrect-roundings)
}

/// Pixels that must have matched for a tile's range to be narrowed.
ROADSTEREO_HD inline std::uint32_t min_tile_pixels(int tile_pixels) {
  return static_cast<std::uint32_t>(tile_pixels / 20);
}

/// Pixels that must agree on a disparity, of those seen in the tile.
ROADSTEREO_HD inline std::uint32_t needed_support(std::uint32_t seen) {
  constexpr double min_support = 0.003;
  const auto needed = static_cast<std::uint32_t>(min_support * seen);
  return needed > 3 ? needed : 3;
}

/// Whether enough pixels agree on the disparities from d on: one of the coarse pair stands for `factor` of them.
ROADSTEREO_HD inline bool is_supported(const std::uint32_t* counts, int bins, int d, int factor, std::uint32_t needed) {
  std::uint32_t sum = 0;
  for (int k = d; k < d + factor && k < bins; ++k) sum += counts[k];
  return sum >= needed;
}

/// The range around the lowest and the highest disparity seen.
ROADSTEREO_HD inline SearchRange range_around(int lowest, int highest, int disparities) {
  constexpr int margin = 3;      // disparities beyond those seen
  constexpr int range_grid = 8;  // ranges grow to multiples of this: vectors hold so many anyway
  int first = lowest - margin, end = highest + margin + 1;
  const int spare = (range_grid - (end - first) % range_grid) % range_grid;
  first -= spare / 2;
  end += spare - spare / 2;
  first = first < 0 ? 0 : first > disparities - 1 ? disparities - 1 : first;
  end = end < first + 1 ? first + 1 : end > disparities ? disparities : end;
  return {static_cast<std::int16_t>(first), static_cast<std::int16_t>(end)};
}

}  // namespace roadstereo
