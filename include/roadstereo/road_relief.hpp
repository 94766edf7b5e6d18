#pragma once

#include "roadstereo/road_map.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Reads cells with heights above a smooth reference of the road instead of z = 0. The reference at a node of a grid of
/// 0.1 m is a plane through the means of the nodes within 0.75 m, by IRLS with Tukey's biweight, so that damage does
/// not bend it; bilinear between nodes. NaN where fewer than a fifth of these nodes are measured.
MapRaster read_relief(const RoadMap& map, const MapBox& box);

}  // namespace roadstereo
#pragma GCC visibility pop
