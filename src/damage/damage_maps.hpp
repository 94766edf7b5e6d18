#pragma once

#include "damage/measurement.hpp"
#include "roadstereo/surroundings.hpp"

namespace roadstereo {

/// The pixels among which those of a candidate lie.
PixelBox pixels_of(const Candidate& candidate, const Cells& cells);

/// Fills the maps of `result` at full size: ids, road, surface, and depth in pixels of ℓ'. Where a damage was not
/// measured, or a single island in it lies no deeper than its outline, depth is what surrounds the gap.
void paint_maps(const DamageInput& input, const Segmentation& found, int threads, DamageMap& result);

}  // namespace roadstereo
