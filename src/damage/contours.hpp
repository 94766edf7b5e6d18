#pragma once

#include <array>
#include <vector>

#include "damage/neighbours.hpp"
#include "damage/outline.hpp"

namespace roadstereo {

/// The line around a region.
struct Contour {
  double slope = 0;  ///< mean along it, pixels of ℓ' per cell
  double area = 0;   ///< inside, cells
};

/// Around a region as it is.
Contour contour_of(const DepthField& field, const BoxMask& region);

inline constexpr int contour_levels = 24;

/// Around what hangs together with `seeds` within a box and lies deeper than each of the levels, which rise.
std::array<Contour, contour_levels> contours_around(const DepthField& field, const ConnectedRegion& seeds,
                                                    const std::array<float, contour_levels>& levels, const Box& within);

/// Whether a cell of the region has a neighbour in the picture that is none; and all that have.
bool on_contour(const BoxMask& region, int i, int j, int columns, int rows);
std::vector<CellIndex> contour_cells(const BoxMask& region, int columns, int rows);

}  // namespace roadstereo
