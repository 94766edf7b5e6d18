#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "roadstereo/io/geotiff.hpp"
#include "roadstereo/map_inventory.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Draws a map for reports, as JPEG: the orthophoto above the heights relative to the smooth reference of the road,
/// both with outlines and numbers of the damages, and a scale bar. The picture is cropped to the measured cells and, if
/// the map is longer than wide, turned clockwise, so that +y points to the right. Blocks are read one after another;
/// their cells are averaged to at most 1200 pixels. `relief`: heights relative to the reference (`MapLayer::relief`).
/// Throws Error for an empty map.
std::vector<std::uint8_t> map_picture(const MapBox& bounds, const MapReference& reference, const ReadMap& read,
                                      const ReadMap& relief, std::span<const RoadDamageRecord> damages);

}  // namespace roadstereo::io
#pragma GCC visibility pop
