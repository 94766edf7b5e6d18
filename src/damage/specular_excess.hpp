#pragma once

#include "roadstereo/damage.hpp"
#include "roadstereo/pixel_box.hpp"

// A matte surface is as bright in both images. The glint of a light on a wet road is not: it lies at its own disparity
// and draws that of the stones under it to it. ZNCC, which matching compares by, does not see brightness. A dark hole
// may differ as much between the images (stones in it shine, too), but glint is brighter than the road.

namespace roadstereo {

/// RMS over damage `id` of the brightness of one image above that of the other along the measured disparities, as far
/// as it is brighter than the road around, in brightnesses of that road. Brightness is the mean of 11×11 pixels; the
/// median around the damage is the same in both images. NaN if unknown: without a right image, and where too little is
/// known.
double specular_excess(const DamageInput& input, const DamageMap& maps, int id, const PixelBox& box);

}  // namespace roadstereo
