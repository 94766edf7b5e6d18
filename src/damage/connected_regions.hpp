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

/// Sets every part of `mask` that is 0 and enclosed by it within `box`, when it has at most `most_cells`.
void fill_enclosed(Image<std::uint8_t>& mask, const Box& box, std::size_t most_cells);

/// Every cell within `radius` columns and rows of one that is not 0 (grow), or away from one that is 0 (shrink; the
/// border does not shrink it). Looks at `box` only; outside it the result is 0.
Image<std::uint8_t> grow(const Image<std::uint8_t>& mask, int radius, const Box& box);
Image<std::uint8_t> shrink_mask(const Image<std::uint8_t>& mask, int radius, const Box& box);

/// The box of a whole image.
template <class Value>
Box whole(const Image<Value>& image) {
  return {0, 0, image.width() - 1, image.height() - 1};
}

}  // namespace roadstereo
