#pragma once

#include <array>
#include <vector>

#include "roadstereo/damage.hpp"

namespace roadstereo {

/// Trace the outer border of a damage in `ids` along the edges of its pixels, and simplify it (Douglas–Peucker) to
/// `tolerance_px`. Corners (u, v) of a polygon that is not closed, clockwise in the image; of several components the
/// first in the image.
std::vector<std::array<double, 2>> trace_outline(const Image<std::uint16_t>& ids, const Damage& damage,
                                                 double tolerance_px);

}  // namespace roadstereo
