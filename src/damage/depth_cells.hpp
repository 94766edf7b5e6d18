#pragma once

#include "damage/cells.hpp"
#include "damage/road_surface.hpp"

namespace roadstereo {

/// Depth of the measured surface below the undamaged road, per cell.
struct DepthCells {
  Image<float> depth;  ///< pixels of ℓ', 5×5 binomial mean of the valid cells; interpolated where none is valid
  Image<std::uint8_t> valid;  ///< 255 where the cell was measured
  double noise = 0;           ///< robust standard deviation of a cell of the intact road, pixels
  double smoothing = 0;       ///< standard deviation of the Gaussian that walls are spread by, cells
};

DepthCells make_depth_cells(const Cells& cells, const RoadSurface& surface, int threads);

/// Push–pull interpolation (Gortler et al., "The Lumigraph", 1996): replaces the cells where `valid` is 0 by means of
/// ever larger neighbourhoods. At least one cell must be valid.
void fill_gaps(Image<float>& values, const Image<std::uint8_t>& valid, int threads);

}  // namespace roadstereo
