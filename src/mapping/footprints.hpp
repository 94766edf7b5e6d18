#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "roadstereo/map_damage.hpp"

namespace roadstereo {

/// Order of MapCells.
inline bool cell_less(const std::array<std::int32_t, 2>& a, const std::array<std::int32_t, 2>& b) {
  return a[1] != b[1] ? a[1] < b[1] : a[0] < b[0];
}

/// Adds the cells of `footprint_m` whose centres lie in a convex quadrilateral, metres, its corners in order.
void add_cells_inside(const std::array<std::array<double, 2>, 4>& corners, MapCells& cells);

/// Bounding box of cells; without any it overlaps none.
struct CellBounds {
  std::array<std::int32_t, 2> first{0, 0}, last{-1, -1};

  bool overlaps(const CellBounds& other) const {
    return first[0] <= other.last[0] && other.first[0] <= last[0] && first[1] <= other.last[1] &&
           other.first[1] <= last[1];
  }
};

CellBounds bounds_of(const MapCells& cells);

/// Smallest overlap of two findings of one damage, as `overlap_share`.
inline constexpr double min_overlap_share = 0.2;

/// Share of the smaller of two footprints that both cover.
inline double overlap_share(const MapCells& one, const MapCells& other) {
  if (one.empty() || other.empty()) return 0;
  const auto above = [](const MapCells& a, const MapCells& b) { return a.back()[1] < b.front()[1]; };
  if (above(one, other) || above(other, one)) return 0;
  std::size_t common = 0;
  for (auto a = one.begin(), b = other.begin(); a != one.end() && b != other.end();) {
    if (cell_less(*a, *b)) {
      ++a;
    } else if (cell_less(*b, *a)) {
      ++b;
    } else {
      ++common;
      ++a;
      ++b;
    }
  }
  return static_cast<double>(common) / static_cast<double>(std::min(one.size(), other.size()));
}

}  // namespace roadstereo
