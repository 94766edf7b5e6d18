#pragma once

#include <cstdint>

#include "damage/box_mask.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// Left image for the refinement of outlines by grey level.
struct ImageEdges {
  ImageView<const std::int16_t> grey;  ///< 1/16 grey level; empty if there is no image
  int factor = 1;                      ///< side of a cell, pixels
  int window_radius = 0;               ///< radius of the support window of matching, cells; of one seen from above
};

/// Region growing by grey level: extends a depression to its edge in the image. The support window of matching carries
/// the disparity of the road over the rim of a steep wall, and occluded parts of the wall have no disparity; the image
/// shows both. Cells within `window_radius` of the region, and `window_rows` of its rows, join it if they are connected
/// to it and the likelihood of their grey level inside, or of the median there if they differ even more from the road,
/// is at least 4.5 times that on the road, and that of their level is larger than on the road in their octant: a
/// shadow, a patch or a stain that ends at the damage is no part of it. What is on the other side of the road's tone
/// does not, nor does what is `hidden` (not 0), of the size of the image of cells: under a mask the picture shows no
/// road. Nor do `other_hollows`, which may be as dark.
void refine_outline_by_image(const ImageEdges& image_edges, const Image<std::uint8_t>& hidden,
                             const BoxMask& other_hollows, int window_rows, BoxMask& region);

}  // namespace roadstereo
