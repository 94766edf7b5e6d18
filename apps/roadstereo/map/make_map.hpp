#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "map/map_plan.hpp"
#include "roadstereo/map_inventory.hpp"
#include "stop_signals.hpp"

namespace roadstereo::cli {

/// What a map has for the terminal and for reports.
struct MapSummary {
  std::string json;                       ///< map.json
  std::string text;                       ///< for the terminal
  std::vector<std::uint8_t> picture;      ///< `io::map_picture`
  std::vector<RoadDamageRecord> damages;  ///< at the places of damages.csv, without their footprints
};

/// Makes a map and writes its files to `plan.output`. Throws Error if no frame with a pose has a road, Interrupted
/// after Ctrl-C.
MapSummary make_map(const MapPlan& plan, const StopSignals& stop);

}  // namespace roadstereo::cli
