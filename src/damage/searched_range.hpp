#pragma once

#include "roadstereo/damage.hpp"
#include "roadstereo/pixel_box.hpp"

// Matching takes the best of the disparities that it searches, whatever the picture shows. Where that is something at a
// disparity that was not searched, such as the top of a vehicle or text in the picture, the best is a match by chance.

namespace roadstereo {

/// Mean vote, −1 … 1, of windows of 15×15 pixels on damage `id` for the measured disparities against the best of those
/// that were not searched, parallel to the road and from infinity to half of its distance. 0 or less: the measured ones
/// are a match by chance. NaN if unknown: without a right image or the range that was searched, and where no window
/// with contrast is inside the picture.
double range_vote(const DamageInput& input, const DamageMap& maps, int id, const PixelBox& box);

}  // namespace roadstereo
