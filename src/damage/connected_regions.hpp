#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// First and last column and row, both inside.
struct Box {
  int first_column = 0, first_row = 0, last_column = -1, last_row = -1;

  bool empty() const { return last_column < first_column; }
  void add(int column, int row);
  Box grown(int by, int width, int height) const;  ///< within an image of that size
};

/// Cells of a mask that hang together, by their sides.
struct ConnectedRegion {
  std::vector<std::int32_t> cells;  ///< row · width + column
  Box box;
  bool touches_border = false;
};

/// The regions of the cells that are not 0, in the order of their first cells.
std::vector<ConnectedRegion> connected_regions(const Image<std::uint8_t>& mask);

/// Sets every part of `mask` that is 0 and enclosed by it, when it has at most `most_cells`.
void fill_enclosed(Image<std::uint8_t>& mask, std::size_t most_cells);

/// Every cell within `radius` columns and rows of one that is not 0 (grow), or away from one that is 0 (shrink; the
/// border of the image does not shrink it).
Image<std::uint8_t> grow(const Image<std::uint8_t>& mask, int radius);
Image<std::uint8_t> shrink_mask(const Image<std::uint8_t>& mask, int radius);

}  // namespace roadstereo
