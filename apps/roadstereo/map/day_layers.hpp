#pragma once

#include "map/build_map.hpp"
#include "roadstereo/io/geotiff.hpp"

namespace roadstereo::cli {

// The road as it was last seen: cells of the newest day that measures them.

/// Smallest box with the tiles of all days.
MapBox bounds_of(const BuiltMap& built);
/// Reads cells. Refers to `built`.
io::ReadMap newest_cells(const BuiltMap& built);
/// Reads cells with heights above the smooth reference of their day. Refers to `built`.
io::ReadMap newest_relief(const BuiltMap& built);

}  // namespace roadstereo::cli
