#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "commands.hpp"
#include "map/make_map.hpp"
#include "map/map_settings.hpp"

namespace roadstereo::cli {
namespace {

void map(const MapSettings& settings) {
  const MapPlan plan = settings.plan();
  const auto stop = std::make_unique<StopSignals>();
  const MapSummary made = make_map(plan, *stop);
  if (settings.json) fmt::print("{}", made.json);
  if (!settings.json && !settings.quiet) fmt::print("{}", made.text);
}

constexpr const char* map_footer = R"(Fuses the frames of recordings whose poses are known into one map of the road.

A trajectory has one line of 12 numbers per frame: the 3×4 matrix from the camera (x right, y down, z forward) to the
world, metres, as KITTI has it; "nan" where a pose is unknown. The axes of the map are those of the road under the first
camera: x to its right, y ahead, z up. With --crs they are those of the trajectory: x east, y north, z up.

SOURCE may be an output folder of inspect --trajectory, which knows recording, poses and options. Recordings of several
days (by the times of their frames, or --day) are compared: changes.csv has damage that is new, grown or repaired.

Example:
  roadstereo synth --scene uav --frames 40 --flight default --output flight
  roadstereo map flight --trajectory flight/trajectory_kitti.txt --calibration flight/calibration.yaml --output map)";

}  // namespace

void add_map(CLI::App& app) {
  CLI::App* command = app.add_subcommand("map", "Map of a road from recordings and their trajectories");
  command->footer(map_footer);
  const auto settings = std::make_shared<MapSettings>();
  command
      ->add_option(
          "SOURCE", settings->source,
          "Recordings, one per trajectory; or left and right of one; or an output folder of inspect --trajectory")
      ->required();
  command->add_option("--trajectory", settings->trajectory, "Poses of a recording; repeat for several recordings")
      ->type_name("FILE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
  command
      ->add_option("--day", settings->day,
                   "Day of a recording, repeat for each; default: the date of its frames. Days are compared")
      ->type_name("NAME")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
  add_calibration_option(*command, settings->calibration);
  command->add_option("--output", settings->output, "Output folder; created if missing")->type_name("DIR")->required();
  command->add_option("--cell", settings->cell_m, "Side of a cell, metres; default: by the first frame")
      ->type_name("M");
  command
      ->add_option("--crs", settings->crs,
                   "Coordinate system of the trajectories, z up, e.g. EPSG:32632; default: that of the runs")
      ->type_name("NAME");
  command->add_option("--every", settings->every, "Process every N-th frame")->type_name("N");
  command->add_flag("--points", settings->points, "Write points.ply, too");
  command->add_flag("--las", settings->las, "Write points.las, too: LAS 1.4 with colours and standard errors");
  command->add_flag("--resume", settings->resume, "Continue the map in the output folder, after Ctrl-C or a kill");
  command->add_flag("--quiet", settings->quiet, "Print nothing on success");
  command->add_flag("--json", settings->json, "Print map.json instead of the summary");
  add_source_options(*command, settings->source_settings);
  add_processing_options(*command, settings->processing);
  command->callback([settings, command] {
    settings->sets_severity = command->count("--severity") > 0;
    map(*settings);
  });
}

}  // namespace roadstereo::cli
