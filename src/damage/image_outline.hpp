#pragma once

#include "damage/connected_regions.hpp"

namespace roadstereo {

/// Moves the outline of a depression out to where the picture shows its edge. The window of matching carries the road's
/// disparity some pixels over the rim of a steep wall, and what the rim hides has none: there the picture is the better
/// witness, when inside and outside differ in it. Cells within `reach` of the region join it when their grey is nearer
/// to the inside's than to the road's and they hang together with it.
void extend_by_image(const Image<float>& grey, int reach, const Box& box, Image<std::uint8_t>& region);

}  // namespace roadstereo
