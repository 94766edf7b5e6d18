#pragma once

#include "damage/measurement.hpp"
#include "roadstereo/pixel_box.hpp"

namespace roadstereo {

/// Bounding box of the pixels of a candidate, with a margin of one cell.
PixelBox pixel_box(const Candidate& candidate, const Cells& cells);

/// Give the maps their size.
void resize_maps(int width, int height, DamageMap& result);

/// Fill the rows `first` … `last` − 1 of the maps regardless of damage: no ids, road, surface, and measured depth in
/// pixels of ℓ'.
void fill_road_rows(const DamageInput& input, const Segmentation& segmentation, int first, int last, DamageMap& result);

/// Depth cells in which islands, cells inside a damage no deeper than its outline, and gaps are interpolated.
Image<float> depth_without_islands(const Segmentation& segmentation, int threads);

/// Fill the ids of all candidates, where there is a surface: the number of the candidate from 1 on. Outlines run
/// between the centres of cells.
void rasterise(const Segmentation& segmentation, DamageMap& result);

/// Add candidate `k` to the road region. Its holes and the cells no deeper than the outline take the depths
/// `interpolated` from their surroundings.
void fill_damage(const Segmentation& segmentation, std::size_t k, const Image<float>& interpolated, DamageMap& result);

/// Empty the pixels of candidate `k` beyond its rim.
void empty_beyond_rim(const DamageInput& input, const Segmentation& segmentation, std::size_t k, DamageMap& result);

/// Give a pixel of a candidate that is no damage what `fill_road_rows` filled in.
void empty_pixel(const DamageInput& input, const Segmentation& segmentation, int u, int v, DamageMap& result);

}  // namespace roadstereo
