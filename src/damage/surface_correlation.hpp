#pragma once

#include "damage/cells.hpp"
#include "damage/road_surface.hpp"
#include "roadstereo/pixel_box.hpp"

// Zero-mean normalised cross-correlation (ZNCC) of 5×5 blocks of the left image with the right one, along the measured
// disparities and along the undamaged road. A structure that one camera alone sees correlates along neither; the
// texture around it correlates along the road.

namespace roadstereo {

/// Standard errors by which the blocks on damage `id` correlate better along the measured disparities than along the
/// surface of `maps`, raised by `offset`: their mean vote in [−1, 1] times the root of the number of independent
/// blocks. NaN without a right image or a disparity map.
double surface_significance(const DamageInput& input, const DamageMap& maps, int id, const PixelBox& box,
                            double offset);

/// Move cells onto the surface that are off it while, in the support window of matching around them, the votes are for
/// the road by more than a standard error; none without a right image or a disparity map.
void move_unsupported_cells(const DamageInput& input, const RoadSurface& surface, int threads, Cells& cells);

}  // namespace roadstereo
