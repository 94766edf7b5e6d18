#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "map/build_map.hpp"
#include "stop_signals.hpp"

namespace roadstereo::cli {

inline constexpr const char* points_file = "points.ply";
inline constexpr const char* las_file = "points.las";

/// Writes the rasters of a map, and its points if the plan asks for them. Returns the names of the files. Throws
/// SystemError on a full disk, Interrupted after Ctrl-C.
std::vector<std::string> write_rasters(const MapPlan& plan, const BuiltMap& built, const std::filesystem::path& folder,
                                       const StopSignals& stop);

/// Returns the picture of the map for reports, JPEG. Throws Interrupted after Ctrl-C.
std::vector<std::uint8_t> overview_of(const MapPlan& plan, const BuiltMap& built,
                                      std::span<const RoadDamageRecord> damages, const StopSignals& stop);

/// Removes the files of a map, but not the checkpoint of one that was interrupted.
void remove_map(const std::filesystem::path& folder);

}  // namespace roadstereo::cli
