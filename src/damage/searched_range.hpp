#pragma once

#include "roadstereo/damage.hpp"
#include "roadstereo/pixel_box.hpp"

// Matching selects the best of the searched disparities, whatever the image shows. If the true disparity was not
// searched, as at the top of a vehicle or at text in the image, the best one is a chance match.

namespace roadstereo {

/// Mean vote, −1 … 1, of windows of 15×15 pixels on damage `id` for the measured disparities against the best of those
/// that were not searched, parallel to the road and from infinity to half of its distance. 0 or less: the measured ones
/// are a match by chance. NaN if unknown: without a right image or the range that was searched, and where no window
/// with contrast is inside the picture.
double range_vote(const DamageInput& input, const DamageMap& maps, int id, const PixelBox& box);

}  // namespace roadstereo
