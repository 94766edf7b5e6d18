#pragma once

#include "damage/measurement.hpp"
#include "damage/metric_measurement.hpp"
#include "roadstereo/pixel_box.hpp"

namespace roadstereo {

/// Set what is counted over the pixels of a damage in `box`: its own box, their number and centroid, the share that is
/// measured, and the mean depth of these below the surface raised by `offset`, pixels of ℓ'.
void count_pixels(const DamageInput& input, const DamageMap& maps, double offset, const PixelBox& box, Damage& damage);

/// Measure candidate `k` in pixels.
Damage measure_in_pixels(const DamageInput& input, const Segmentation& segmentation, std::size_t k,
                         const SurfaceOffset& offset, const DamageMap& maps);

}  // namespace roadstereo
