#pragma once

#include "damage/cells.hpp"
#include "damage/road_surface.hpp"

namespace roadstereo {

/// How far the seen surface lies below the undamaged road.
struct DepthCells {
  Image<float> depth;         ///< pixels of ℓ', smoothed over a cell or two; interpolated where nothing was measured
  Image<std::uint8_t> known;  ///< 255 where it was measured
  double noise = 0;           ///< of a cell of the intact road, pixels
};

DepthCells make_depth_cells(const Cells& cells, const RoadSurface& surface);

/// Replaces the cells that `known` leaves out by what surrounds them: means of ever larger cells, interpolated
/// (push–pull).
void interpolate_gaps(Image<float>& values, const Image<std::uint8_t>& known);

}  // namespace roadstereo
