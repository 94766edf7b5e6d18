#pragma once

#include <array>
#include <vector>

#include "damage/neighbours.hpp"
#include "damage/outline.hpp"

namespace roadstereo {

/// Magnitude of the gradient at a cell by central differences; one-sided at the border.
float slope_at(const Image<float>& depth, int i, int j);

/// Contour of a region: the cells of the region that have a 4-neighbour outside it.
struct ContourStatistics {
  double slope = 0;  ///< mean magnitude of the depth gradient on the contour, pixels of ℓ' per cell
  double area = 0;   ///< of the region, cells
};

ContourStatistics measure_contour(const DepthField& field, const BoxMask& region);

inline constexpr int contour_level_count = 24;

/// Measure the contours of the component that contains `seeds` above each of the ascending `levels`, inside `within`.
/// These components are one branch of the component tree (max-tree) of the depth; one flood computes all of them.
std::array<ContourStatistics, contour_level_count> measure_contours(
    const DepthField& field, const ConnectedComponent& seeds, const std::array<float, contour_level_count>& levels,
    const CellBox& within);

/// Cells of a region with a 4-neighbour outside it or beside the image, row by row.
std::vector<CellIndex> rim_cells(const BoxMask& region);

/// Cells of the contour of a region in an image of columns×rows cells, row by row. The border of the image is none.
std::vector<CellIndex> contour_cells(const BoxMask& region, int columns, int rows);

}  // namespace roadstereo
