#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "map/build_map.hpp"

namespace roadstereo::cli {

/// Writes the rasters of a map, and its points if the plan asks for them. Throws SystemError on a full disk.
void write_rasters(const MapPlan& plan, const BuiltMap& built, const std::filesystem::path& folder);

/// Returns the picture of the map for reports, JPEG.
std::vector<std::uint8_t> overview_of(const MapPlan& plan, const BuiltMap& built,
                                      std::span<const RoadDamageRecord> damages);

}  // namespace roadstereo::cli
