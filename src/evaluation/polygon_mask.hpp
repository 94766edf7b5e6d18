// Polygons drawn by hand, filled by the even-odd rule.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Corners (u, v), pixels; the centre of the first pixel is (0, 0).
using Polygon = std::vector<std::array<double, 2>>;

/// Returns a mask of width × height pixels, 255 inside an odd number of the polygons and on their borders.
Image<std::uint8_t> polygon_mask(const std::vector<Polygon>& polygons, int width, int height);

}  // namespace roadstereo
