#pragma once

#include "damage/cells.hpp"
#include "damage/road_surface.hpp"

namespace roadstereo {

/// Cells whose value lies near the surface and that hang together with the largest such part of the picture: the
/// road, and not the verge or a wall that happens to be as high. 255 inside; what the road encloses is not filled.
Image<std::uint8_t> find_road_region(const Cells& cells, const RoadSurface& surface);

}  // namespace roadstereo
