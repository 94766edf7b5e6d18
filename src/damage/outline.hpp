#pragma once

#include "damage/box_mask.hpp"
#include "damage/connected_regions.hpp"

namespace roadstereo {

/// What an outline is drawn in: depth above 0 inside the damage, cells that may not be entered are 0 in `allowed`.
struct DepthField {
  const Image<float>& depth;
  const Image<std::uint8_t>& allowed;
  Image<std::uint8_t>& reached;  ///< scratch of the same size, all 0 between two floods
};

/// The cells that hang together with `seeds` and lie deeper than `level`.
BoxMask flood(const DepthField& field, const ConnectedRegion& seeds, float level);

/// Depth that a quarter of the seeds exceed: the floor, whatever single cells say.
float floor_depth(const DepthField& field, const ConnectedRegion& seeds);

/// Where a damage begins.
struct Outline {
  float level = 0;  ///< depth, pixels of ℓ'
  double steepness =
      0;  ///< of its wall where it is steepest: 1 is a cone of the same opening and depth, 2 the rim of a bowl
};

/// A wide hollow around a pothole belongs to the road's own shape, and the wall to the pothole: of the contours around
/// `seeds`, from the steepest outwards, the last one along which the mean slope is still three times that of a cone
/// with the same opening and depth `floor`. Never below `lowest`. Where nothing says how deep a hollow really is
/// (`metric` is false), no higher than 0.6 of the depth: halfway up the wall.
Outline find_outline(const DepthField& field, const ConnectedRegion& seeds, float floor, float lowest, bool metric);

/// Grows a region to the foot of its wall: over cells that are deeper than what lies around it, no farther than the
/// wall's own slope, continued, reaches. `least` is the depth that noise makes.
void grow_to_foot(const DepthField& field, float level, float least, BoxMask& region);

}  // namespace roadstereo
