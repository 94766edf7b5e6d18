#pragma once

#include "damage/measurement.hpp"
#include "roadstereo/pixel_box.hpp"

namespace roadstereo {

/// Bounding box of the pixels of a candidate, with a margin of one cell.
PixelBox pixel_box(const Candidate& candidate, const Cells& cells);

/// Fill the maps of `result` at full resolution: ids, road, surface, and depth in pixels of ℓ'. Outlines run between
/// the centres of cells. Inside a damage, holes and cells no deeper than the outline are interpolated from their
/// surroundings.
void fill_maps(const DamageInput& input, const Segmentation& segmentation, int threads, DamageMap& result);

}  // namespace roadstereo
