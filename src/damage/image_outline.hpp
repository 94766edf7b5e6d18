#pragma once

#include <cstdint>

#include "damage/box_mask.hpp"

namespace roadstereo {

/// The left image, and how far the window of matching reaches over an edge in it.
struct Witness {
  ImageView<const std::int16_t> grey;  ///< empty: there is none
  int factor = 1;                      ///< pixels along the side of a cell
  int reach = 0;                       ///< cells
};

/// Moves the outline of a depression out to where the picture shows its edge. The window of matching carries the road's
/// disparity some pixels over the rim of a steep wall, and what the rim hides has none: there the picture is the better
/// witness, when inside and outside differ in it. Cells within the witness's reach of the region join it when their
/// grey is nearer to the inside's than to the road's and they hang together with it.
void extend_by_image(const Witness& witness, int columns, int rows, BoxMask& region);

}  // namespace roadstereo
