#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "commands.hpp"
#include "map/build_map.hpp"
#include "map/map_files.hpp"
#include "map/map_results.hpp"
#include "map/map_settings.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/output_folder.hpp"

namespace roadstereo::cli {
namespace {

void make_map(const MapSettings& settings) {
  settings.validate();
  io::OutputFolder folder(settings.output);  // fails early
  const auto stop = std::make_unique<StopSignals>();
  const BuiltMap built = build_map(settings, folder.path() / ".tiles", *stop);
  if (!built.map) {
    fail("none of the ", built.frames, " frames with a pose has a road",
         built.reasons.empty() ? std::string() : ": " + built.reasons.front());
  }
  const MapResults results = measure_map(built);
  write_rasters(settings, built, folder.path());
  add_map_tables(settings, built, results, folder);
  const std::string json = map_json(settings, built, results);
  folder.add("map.json", json);
  folder.commit();
  if (settings.json) fmt::print("{}", json);
  if (!settings.json && !settings.quiet) fmt::print("{}", map_text(settings, built, results));
}

constexpr const char* map_footer = R"(Fuses the frames of recordings whose poses are known into one map of the road.

A trajectory has one line of 12 numbers per frame: the 3×4 matrix from the camera (x right, y down, z forward) to the
world, metres, as KITTI has it; "nan" where a pose is unknown. The axes of the map are those of the road under the first
camera: x to its right, y ahead, z up. With --crs they are those of the trajectory: x east, y north, z up.

Example:
  roadstereo synth --scene uav --frames 40 --flight default --output flight
  roadstereo map flight --trajectory flight/trajectory_kitti.txt --calibration flight/calibration.yaml --output map)";

}  // namespace

void add_map(CLI::App& app) {
  CLI::App* command = app.add_subcommand("map", "Map of a road from recordings and their trajectories");
  command->footer(map_footer);
  const auto settings = std::make_shared<MapSettings>();
  command->add_option("SOURCE", settings->source, "Recordings, one per trajectory; or left and right of one")
      ->required();
  command->add_option("--trajectory", settings->trajectory, "Poses of a recording; repeat for several recordings")
      ->type_name("FILE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all()
      ->required();
  add_calibration_option(*command, settings->calibration);
  command->add_option("--output", settings->output, "Output folder; created if missing")->type_name("DIR")->required();
  command->add_option("--cell", settings->cell_m, "Side of a cell, metres; default: by the first frame")
      ->type_name("M");
  command->add_option("--crs", settings->crs, "Coordinate system of the trajectories, z up, e.g. EPSG:32632")
      ->type_name("NAME");
  command->add_option("--every", settings->every, "Process every N-th frame")->type_name("N");
  command->add_flag("--points", settings->points, "Write points.ply, too");
  command->add_flag("--quiet", settings->quiet, "Print nothing on success");
  command->add_flag("--json", settings->json, "Print map.json instead of the summary");
  add_source_options(*command, settings->source_settings);
  add_processing_options(*command, settings->processing);
  command->callback([settings] { make_map(*settings); });
}

}  // namespace roadstereo::cli
