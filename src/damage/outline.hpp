#pragma once

#include "damage/box_mask.hpp"
#include "damage/connected_components.hpp"

namespace roadstereo {

/// Field in which outlines are searched. All images have one size.
struct DepthField {
  const Image<float>& depth;           ///< pixels of ℓ', positive inside the kind of damage that is searched
  const Image<std::uint8_t>& allowed;  ///< 0: the cell cannot belong to a damage
  Image<std::uint8_t>& visited;        ///< scratch; all 0 between calls
};

/// Flood fill: the component of allowed cells deeper than `level` that contains `seeds`.
BoxMask flood_fill(const DepthField& field, const ConnectedComponent& seeds, float level);

/// Depth of the floor: 75th percentile of the depths of the seeds, robust against single outliers.
float floor_depth(const DepthField& field, const ConnectedComponent& seeds);

/// Outline of a damage.
struct Outline {
  float level = 0;  ///< depth at the outline, pixels of ℓ'
  /// Maximum over the levels of the mean slope on the contour, relative to that of a cone of the same area and depth: 1
  /// for a cone, 2 for a paraboloid.
  double steepness = 0;
};

/// Select the level of the outline from the slopes of the contours around `seeds` in the component tree. A wide shallow
/// hollow around a pothole belongs to the shape of the road; the wall belongs to the pothole. Starting at the steepest
/// contour, the level descends as long as the mean slope is at least three times that of a cone of the same area and of
/// depth `floor`, or 0.9 of the maximum if that is less. It does not fall below `min_level`. If `metric` is false, the
/// depth of a hollow is not known in metres; the level is then at least 0.6 · `floor`, about halfway up the wall.
Outline find_outline(const DepthField& field, const ConnectedComponent& seeds, float floor, float min_level,
                     bool metric);

/// Grow a region to the foot of its wall: over allowed cells that are deeper than the surroundings and than
/// `min_depth`, at most as far as the wall, extrapolated with its mean slope, takes to reach the depth of the
/// surroundings.
void grow_to_wall_foot(const DepthField& field, float level, float min_depth, BoxMask& region);

}  // namespace roadstereo
