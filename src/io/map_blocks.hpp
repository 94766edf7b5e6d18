#pragma once

#include <algorithm>

#include "roadstereo/io/geotiff.hpp"

namespace roadstereo::io {

/// Calls `visit(MapRaster)` for the blocks of a map, south first.
template <class Visit>
void for_each_block(const MapBox& bounds, const ReadMap& read, const Visit& visit) {
  constexpr int block = 512;
  for (int j = 0; j < bounds.rows; j += block) {
    for (int i = 0; i < bounds.columns; i += block) {
      visit(
          read({bounds.i0 + i, bounds.j0 + j, std::min(block, bounds.columns - i), std::min(block, bounds.rows - j)}));
    }
  }
}

/// Calls `visit(x, y, z, u, v)` for the measured cells of a block: the middle of cell (u, v) in the coordinates of
/// `reference`.
template <class Visit>
void for_each_point(const MapRaster& raster, const MapReference& reference, const Visit& visit) {
  const MapBox& box = raster.box;
  for (int v = 0; v < box.rows; ++v) {
    for (int u = 0; u < box.columns; ++u) {
      if (raster.views(u, v) == 0) continue;
      visit(reference.east_m + (box.i0 + u + 0.5) * reference.cell_m,
            reference.north_m + (box.j0 + box.rows - v - 0.5) * reference.cell_m, reference.up_m + raster.height(u, v),
            u, v);
    }
  }
}

}  // namespace roadstereo::io
