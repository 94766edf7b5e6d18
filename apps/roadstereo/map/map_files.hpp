#pragma once

#include <filesystem>

#include "map/build_map.hpp"
#include "map/map_settings.hpp"

namespace roadstereo::cli {

/// Writes the rasters of a map, and its points if the settings ask for them. Throws SystemError on a full disk.
void write_rasters(const MapSettings& settings, const BuiltMap& built, const std::filesystem::path& folder);

}  // namespace roadstereo::cli
