#pragma once

#include "roadstereo/damage.hpp"
#include "roadstereo/pixel_box.hpp"

// A bump is made of the road, or of something that lies on it: around it is road. A verge, a traffic island or a
// pavement that the road region includes is of another material, and what rises from it is as well.

namespace roadstereo {

/// By how much more often the image around damage `id` has the texture of its inside, rather than that of the road,
/// than the road has: −1 … 1, about 0 if road surrounds it. Texture is the contrast of blocks of 12×12 pixels: the
/// logarithm of the RMS of the gradient over the mean grey level, which a shadow does not change. 0 if the medians of
/// the inside and of the road differ by less than two standard deviations of the inside. NaN if unknown: without an
/// image, and where too little is in view.
double texture_share(const DamageInput& input, const DamageMap& maps, int id, const PixelBox& box);

}  // namespace roadstereo
