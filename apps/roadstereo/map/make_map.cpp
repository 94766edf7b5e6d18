#include "map/make_map.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "folder_lock.hpp"
#include "io/geo/map_crs.hpp"
#include "map/build_map.hpp"
#include "map/map_files.hpp"
#include "map/map_results.hpp"
#include "map/map_values.hpp"
#include "output_owner.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/output_folder.hpp"

namespace roadstereo::cli {

namespace {

BuiltMap built_map(const MapPlan& plan, const std::filesystem::path& tiles, const StopSignals& stop) {
  BuiltMap built = build_map(plan, tiles, stop);
  const bool had_days = !built.days.empty();
  std::erase_if(built.days, [&](const DayMap& day) {
    if (!day.map.bounds().empty()) return false;
    built.reasons.push_back("the map of " + (day.name.empty() ? std::string("a day") : day.name) + " is empty");
    return true;
  });
  if (!built.days.empty()) return built;
  std::error_code ignored;
  std::filesystem::remove_all(tiles, ignored);
  if (had_days) {
    fail(
        "the map is empty: no frame shows the road sharply enough for a cell. Are the poses in metres, with z up, and ",
        "the cells of --cell not larger than what frames show? ", fmt::format("{}", fmt::join(built.reasons, "; ")));
  }
  fail("none of the ", built.frames, " frames with a pose has a road",
       fmt::format("{}{}", built.reasons.empty() ? "" : ": ", fmt::join(built.reasons, "; ")));
}

}  // namespace

MapSummary make_map(const MapPlan& plan, const StopSignals& stop) {
  require_no_other_owner(plan.output, OutputOwner::map);
  io::OutputFolder folder(plan.output);  // fails early
  const FolderLock lock(folder.path(), folder.path() / ".lock");
  if (!plan.crs.empty()) static_cast<void>(io::map_wkt({.crs = plan.crs}));
  for (const MapPass& pass : plan.passes) {
    for (const auto& inputs : {pass.source, pass.calibration, std::vector{pass.trajectory}}) {
      for (const std::string& input : inputs) folder.protect(input);
    }
  }
  const std::filesystem::path tiles = folder.path() / ".tiles";
  const BuiltMap built = built_map(plan, tiles, stop);
  MapResults results = measure_map(plan, built);
  MapSummary summary;
  summary.json = map_json(plan, built, results);
  summary.text = map_text(plan, built, results);
  summary.picture = overview_of(plan, built, results.damages, stop);
  const std::filesystem::path drafts = tiles / "rasters";
  std::filesystem::create_directories(drafts);
  const std::vector<std::string> rasters = write_rasters(plan, built, drafts, stop);
  add_map_tables(built, results, folder);
  folder.add("map.jpg", summary.picture);
  folder.add("map.json", summary.json);
  for (const std::string& name : rasters) folder.add_file(name, drafts / name);
  for (const char* name : {points_file, las_file}) {
    if (!folder.has(name)) folder.remove(name);
  }
  folder.commit();
  std::error_code ignored;
  std::filesystem::remove_all(tiles, ignored);
  for (RoadDamageRecord& damage : results.damages) {
    damage.best.footprint.clear();
    damage.best.at_m = in_crs(built, damage.best.at_m);
  }
  summary.damages = std::move(results.damages);
  return summary;
}

}  // namespace roadstereo::cli
