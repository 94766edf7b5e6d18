#pragma once

#include "damage/cells.hpp"
#include "damage/road_surface.hpp"
#include "roadstereo/pixel_box.hpp"

// Zero-mean normalised cross-correlation (ZNCC) of 5×5 blocks of the left image with the right one, along the measured
// disparities and along the undamaged road. A structure that one camera alone sees correlates along neither; the
// texture around it correlates along the road.

namespace roadstereo {

/// Share, 0 … 1, of the blocks on damage `id` that correlate better along the measured disparities than along the
/// surface of `maps`, raised by `offset`; each block weighs the square of the better correlation. NaN without a right
/// image, a disparity map or a block with texture.
double surface_share(const DamageInput& input, const DamageMap& maps, int id, const PixelBox& box, double offset);

/// Move cells onto the surface that are off it while, in the support window of matching around them, the blocks that
/// correlate along the road weigh more. Returns whether there were any; none without a right image or a disparity map.
bool move_unsupported_cells(const DamageInput& input, const RoadSurface& surface, int threads, Cells& cells);

}  // namespace roadstereo
