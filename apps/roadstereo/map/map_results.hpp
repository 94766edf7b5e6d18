#pragma once

#include <string>
#include <vector>

#include "map/build_map.hpp"
#include "map/map_settings.hpp"
#include "roadstereo/io/output_folder.hpp"
#include "roadstereo/road_profile.hpp"

namespace roadstereo::cli {

/// What is measured on a map.
struct MapResults {
  std::vector<RoadDamageRecord> damages;
  std::vector<LaneProfiles> lanes;  ///< of each path
};

/// Finds damage in the map, joins it with that of the frames, and measures profiles along the paths.
MapResults measure_map(const BuiltMap& built);

/// Stages damages.csv, sightings.csv, transverse.csv, longitudinal.csv and roughness.csv.
void add_map_tables(const MapSettings& settings, const BuiltMap& built, const MapResults& results,
                    io::OutputFolder& folder);

/// Returns map.json.
std::string map_json(const MapSettings& settings, const BuiltMap& built, const MapResults& results);

/// Returns the summary for the terminal.
std::string map_text(const MapSettings& settings, const BuiltMap& built, const MapResults& results);

}  // namespace roadstereo::cli
