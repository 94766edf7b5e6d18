#pragma once

#include <array>

#include "damage/box_mask.hpp"
#include "damage/connected_components.hpp"
#include "damage/octants.hpp"
#include "damage/robust_normal.hpp"

namespace roadstereo {

/// Field in which outlines are searched. All images have one size.
struct DepthField {
  const Image<float>& depth;           ///< pixels of ℓ', positive inside the kind of damage that is searched
  const Image<std::uint8_t>& allowed;  ///< 0: the cell cannot belong to a damage
  Image<std::uint8_t>& visited;        ///< scratch; all 0 between calls
};

/// Flood fill: the component of allowed cells deeper than `level` that contains `seeds`.
BoxMask flood_fill(const DepthField& field, const ConnectedComponent& seeds, float level);

/// Distribution of the depths of the allowed cells in a band around a region: farther than `near_cells`, as wide as
/// `band_radii` times the radius √(area / π) of the region, at least 3 cells.
RobustNormal depths_around(const DepthField& field, const BoxMask& region, int near_cells, double band_radii);

/// The same band, and its halves, each of four octants around the region.
struct BandAround {
  RobustNormal whole;
  std::array<RobustNormal, Octants::count> halves;
};
BandAround band_around(const DepthField& field, const BoxMask& region, int near_cells, double band_radii);

/// Depth of the floor of a hollow: 75th percentile of those depths that are deeper than half of it, robust against
/// single outliers and independent of how much of the hollow they cover.
float floor_of(std::vector<float> depths);
/// Depth of the floor of the seeds.
float floor_depth(const Image<float>& depth, const ConnectedComponent& seeds);

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
/// depth of a hollow is not known in metres; the level is then halfway between the floor and the surroundings.
Outline find_outline(const DepthField& field, const ConnectedComponent& seeds, float floor, float min_level,
                     bool metric);

/// Grow a region over the allowed cells near gaps. Where matching failed on a ragged wall, the depth between the road
/// and the floor is smeared: cells no farther than the radius of the support window from a cell that is not `valid`
/// join the region if they are connected to it and deeper than 2.5 standard deviations of the surroundings and
/// `min_level`.
void grow_over_gaps(const DepthField& field, const Image<std::uint8_t>& valid, float min_level, int window_radius,
                    BoxMask& region);

/// Grow a region to the foot of its wall: over allowed cells that are deeper than the surroundings and than
/// `min_depth`, at most as far as the wall, extrapolated with its mean slope, takes to reach the depth of the
/// surroundings.
void grow_to_wall_foot(const DepthField& field, float level, float min_depth, BoxMask& region);

}  // namespace roadstereo
