#pragma once

#include <string>
#include <vector>

#include "map/build_map.hpp"
#include "map/day_changes.hpp"
#include "roadstereo/io/output_folder.hpp"
#include "roadstereo/road_profile.hpp"

namespace roadstereo::cli {

/// What is measured on a map.
struct MapResults {
  std::vector<RoadDamageRecord> damages;  ///< of the newest day that measures their place
  std::vector<std::size_t> damage_days;   ///< index of that day, of each damage
  std::vector<LaneProfiles> lanes;        ///< of each path, day by day
  std::vector<DayChange> changes;
};

/// Finds damage in the map of every day, joins it with that of the frames, measures profiles along the paths, and
/// compares the days.
MapResults measure_map(const MapPlan& plan, const BuiltMap& built);

/// Stages damages.csv, sightings.csv, transverse.csv, longitudinal.csv and roughness.csv, of several days also
/// changes.csv.
void add_map_tables(const BuiltMap& built, const MapResults& results, io::OutputFolder& folder);

/// Returns map.json.
std::string map_json(const MapPlan& plan, const BuiltMap& built, const MapResults& results);

/// Returns the summary for the terminal.
std::string map_text(const MapPlan& plan, const BuiltMap& built, const MapResults& results);

}  // namespace roadstereo::cli
