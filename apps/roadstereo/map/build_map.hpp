#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "map/map_settings.hpp"
#include "roadstereo/map_inventory.hpp"
#include "roadstereo/road_map.hpp"
#include "stop_signals.hpp"

namespace roadstereo::cli {

/// A map of one or several recordings.
struct BuiltMap {
  std::optional<RoadMap> map;        ///< absent if no frame had a road and a pose
  std::array<double, 3> origin_m{};  ///< of the map in the coordinates of the trajectories, with --crs
  DamageOptions damage;              ///< of the settings
  std::vector<DamageSighting> sightings;
  std::vector<std::vector<std::array<double, 2>>>
      paths;                         ///< foot of the camera in the map, frame by frame, of each piece
  std::int64_t frames = 0;           ///< with a pose
  std::int64_t mapped = 0;           ///< of these, with a road
  std::vector<std::string> reasons;  ///< why frames are missing, each once
};

/// Matches the frames that have a pose, fuses them, and finds damage in each. `folder` takes the tiles. Throws Error
/// for an unreadable recording or trajectory.
BuiltMap build_map(const MapSettings& settings, const std::filesystem::path& folder, const StopSignals& stop);

}  // namespace roadstereo::cli
