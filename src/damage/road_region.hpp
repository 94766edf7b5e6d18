#pragma once

#include "damage/cells.hpp"
#include "damage/road_surface.hpp"
#include "damage/ruts.hpp"

namespace roadstereo {

/// Find the road region: cells within 3 standard deviations of the surface, or as near as the relief of a road, in
/// units of the coordinates, that belong to its largest connected component after bands of small errors across
/// it are closed and a morphological opening. Verges and walls of the same height are separate components. 255 inside;
/// holes of more than 30 cells, such as damage, stay 0. Ruts connect what lies to both sides of them.
Image<std::uint8_t> find_road_region(const Cells& cells, const SurfaceCoordinates& coordinates,
                                     const RoadSurface& surface, const Ruts& ruts, double relief_m, int threads);

}  // namespace roadstereo
