#pragma once

#include <array>
#include <vector>

namespace roadstereo::io {

/// Vertices (x, y) of a polygon, not closed.
using Outline = std::vector<std::array<double, 2>>;

/// Share of the smaller of two polygons that both cover, 0 … 1; 0 if one of them has no area.
double outline_overlap(const Outline& one, const Outline& other);

}  // namespace roadstereo::io
