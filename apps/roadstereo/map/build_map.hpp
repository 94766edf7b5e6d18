#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "map/map_plan.hpp"
#include "roadstereo/map_inventory.hpp"
#include "roadstereo/road_map.hpp"
#include "stop_signals.hpp"

namespace roadstereo::cli {

/// The map of the recordings of one day.
struct DayMap {
  std::string name;  ///< as given, or the date in UTC; empty: unknown
  RoadMap map;
  std::vector<DamageSighting> sightings;
  /// (x, y) of the camera in the map, frame by frame, of each piece
  std::vector<std::vector<std::array<double, 2>>> paths;
};

/// Maps of one or several recordings, one a day, in the same axes and cells.
struct BuiltMap {
  std::vector<DayMap> days;          ///< by date, or in the order of their recordings; empty: no road and pose
  std::array<double, 3> origin_m{};  ///< of the map in the coordinates of the trajectories, with --crs
  std::int64_t frames = 0;           ///< with a pose
  std::int64_t mapped = 0;           ///< of these, with a road
  std::vector<std::string> reasons;  ///< why frames are missing, each once
};

/// Matches the frames that have a pose, fuses them, and finds damage in each. `folder` takes the tiles. Throws Error
/// for an unreadable recording or trajectory.
BuiltMap build_map(const MapPlan& plan, const std::filesystem::path& folder, const StopSignals& stop);

}  // namespace roadstereo::cli
