#pragma once

#include <array>
#include <set>
#include <vector>

namespace roadstereo::io {

/// Vertices (x, y) of a polygon, not closed.
using Outline = std::vector<std::array<double, 2>>;

/// Share of the smaller of two polygons that both cover, 0 … 1; 0 if one of them has no area.
double outline_overlap(const Outline& one, const Outline& other);

/// Side of the cells of `cells_of`, metres.
inline constexpr double outline_cell_m = 0.05;

/// Cells whose centres lie in a polygon, as column and row.
std::set<std::array<int, 2>> cells_of(const Outline& outline);

}  // namespace roadstereo::io
