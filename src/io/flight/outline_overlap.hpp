#pragma once

#include <array>
#include <set>
#include <vector>

namespace roadstereo::io {

/// Vertices (x, y) of a polygon, not closed.
using Outline = std::vector<std::array<double, 2>>;

/// Share of the smaller of two polygons that both cover, 0 … 1; 0 if one of them has no area.
double outline_overlap(const Outline& one, const Outline& other);

/// Cells of 0.05 m whose centres lie in a polygon, as column and row, metres.
std::set<std::array<int, 2>> cells_of(const Outline& outline);

}  // namespace roadstereo::io
