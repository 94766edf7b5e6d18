#pragma once

#include <cstdint>
#include <optional>

#include "roadstereo/image.hpp"

// Affine Lucas-Kanade alignment of a block, with gain and offset.

namespace roadstereo {

/// Where a block of the left image lies in the right one: x' = x + du + shear·y + stretch·x, y' = y + dv around its
/// centre. A road seen at a slant is sheared from one view to the other; without the shear a vertical offset would be
/// taken for a horizontal one.
struct BlockAlignment {
  double du = 0;  ///< pixels
  double dv = 0;  ///< pixels
  double shear = 0;
  double stretch = 0;
};

/// Refines `start` by least squares of the grey values (with gain and offset) over the block of the given radius, at
/// most 8, around (u, v). Nothing when the block leaves the images or is stretched by more than half, the fit does not
/// converge within a pixel and a half of `start`, or the fitted block does not correlate.
std::optional<BlockAlignment> affine_lucas_kanade(ImageView<const std::int16_t> left, int u, int v,
                                                  ImageView<const std::int16_t> right, const BlockAlignment& start,
                                                  int radius);

}  // namespace roadstereo
