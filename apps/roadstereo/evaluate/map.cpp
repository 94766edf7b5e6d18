#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "evaluate/experiments.hpp"
#include "evaluate/map_trials.hpp"
#include "evaluate/report.hpp"
#include "evaluate/table.hpp"
#include "finite_values.hpp"

namespace roadstereo::cli {
namespace {

struct MapArguments {
  MapTrialOptions trials;
  int memory_frames = 2000;
  std::string json;
};

constexpr const char* map_note =
    R"(Three passes over each road, the third in the other direction; poses are true, or with --estimated-poses those of
odometry, loops and positions with noise of 0.1 m. best frame: the sighting of smallest
standard error that no border cuts, as in the report of a flight. Memory: growth of the peak of this process after the
first fifth of the frames.
)";

/// RMS of the differences relative to what their standard errors say, over all roads.
double ratio(const std::vector<PassDifference>& differences) {
  double squares = 0, variances = 0;
  for (const PassDifference& difference : differences) {
    if (difference.cells == 0) continue;
    const auto cells = static_cast<double>(difference.cells);
    squares += cells * difference.rms_m * difference.rms_m;
    variances += cells * difference.predicted_m * difference.predicted_m;
  }
  return std::sqrt(squares / variances);
}

/// Figures of the damages.
struct DamageFigures {
  std::vector<double> fused, best;  ///< errors of the depth of those that at least five frames show, metres
  int within = 0, measured = 0;     ///< of depth, mean depth, area and volume, within two standard errors
  int once = 0, missing = 0, repeated = 0;

  void add(const Measurement& measurement, double truth) {
    ++measured;
    within += std::abs(measurement.value - truth) <= 2 * measurement.std_error ? 1 : 0;
  }
};

DamageFigures figures_of(const MapTrials& trials) {
  constexpr int min_sightings = 5;
  DamageFigures figures;
  for (const MapDamageTrial& trial : trials.damages) {
    figures.once += trial.records == 1 ? 1 : 0;
    figures.missing += trial.records == 0 ? 1 : 0;
    figures.repeated += trial.records > 1 ? 1 : 0;
    if (trial.records == 0) continue;
    const RoadDamageRecord& record = trial.record;
    figures.add(record.max_depth_m, trial.truth.depth_m);
    figures.add(record.mean_depth_m, trial.truth.mean_depth_m);
    figures.add(record.area_m2, trial.truth.area_m2);
    figures.add(record.volume_m3, trial.truth.volume_m3);
    if (record.sightings < min_sightings || std::isnan(trial.best_frame_error_m)) continue;
    figures.fused.push_back(record.max_depth_m.value - trial.truth.depth_m);
    figures.best.push_back(trial.best_frame_error_m);
  }
  return figures;
}

Table figure_table(const MapTrials& trials, const DamageFigures& figures, double memory_mib,
                   const MapArguments& arguments) {
  Table table{fmt::format("{} roads, 3 passes of {} frames, preset {}", arguments.trials.roads, arguments.trials.frames,
                          arguments.trials.preset),
              {{"measure", "measure"}, {"value", "value"}, {"goal", "goal"}},
              {}};
  constexpr double mm = 1000;
  table.rows = {{"height between two passes, RMS / standard error", Cell(ratio(trials.forward), 2), "≤ 1.2"},
                {"the same, second pass in the other direction", Cell(ratio(trials.reverse), 2), "≤ 1.2"},
                {"standard error of a height, median: one frame, mm", Cell(mm * median(trials.single_sigma_m), 2), ""},
                {"the same, all frames, mm", Cell(mm * median(trials.fused_sigma_m), 2), ""},
                {"depth, damage seen ≥ 5 times: RMS error, mm", Cell(mm * rms(figures.fused), 1), ""},
                {"the same of the best frame, mm", Cell(mm * rms(figures.best), 1), ""},
                {"quotient", Cell(rms(figures.fused) / rms(figures.best), 2), "≤ 0.7"},
                {"figures within two standard errors, %",
                 Cell(100.0 * figures.within / std::max(1, figures.measured), 0), "90–98"},
                {"true damages", Cell(static_cast<double>(trials.damages.size()), 0), ""},
                {"with one record", Cell(figures.once, 0), "all found"},
                {"without a record", Cell(figures.missing, 0), ""},
                {"with several records", Cell(figures.repeated, 0), "0"},
                {"records without a damage", Cell(trials.false_records, 0), "0"},
                {"frames without a road", Cell(trials.frames_without_road, 0), "0"},
                {fmt::format("memory of {} frames: growth, MiB", arguments.memory_frames), Cell(memory_mib, 1), "0"}};
  return table;
}

Table damage_table(const MapTrials& trials) {
  Table table{"Damages",
              {{"kind", "kind"},
               {"depth mm", "depth_mm"},
               {"radius mm", "radius_mm"},
               {"fused mm", "fused_mm"},
               {"±", "fused_stderr_mm"},
               {"error of best frame mm", "best_frame_error_mm"},
               {"sightings", "sightings"},
               {"passes", "passes"},
               {"confidence", "confidence"},
               {"records", "records"}},
              {}};
  constexpr double mm = 1000;
  for (const MapDamageTrial& trial : trials.damages) {
    const bool found = trial.records > 0;
    const RoadDamageRecord& record = trial.record;
    table.rows.push_back({trial.truth.kind, Cell(mm * trial.truth.depth_m, 1),
                          Cell(mm * std::sqrt(trial.truth.area_m2 / std::numbers::pi), 0),
                          Cell(found ? mm * record.max_depth_m.value : NAN, 1),
                          Cell(found ? mm * record.max_depth_m.std_error : NAN, 1),
                          Cell(mm * trial.best_frame_error_m, 1), Cell(record.sightings, 0), Cell(record.passes, 0),
                          Cell(found ? record.confidence : NAN, 2), Cell(trial.records, 0)});
  }
  return table;
}

void run(const MapArguments& arguments) {
  const double memory_mib = map_memory_growth_mib(arguments.memory_frames);  // before anything else has taken more
  const MapTrials trials = run_map_trials(arguments.trials);
  const DamageFigures figures = figures_of(trials);
  const Table summary = figure_table(trials, figures, memory_mib, arguments);
  const Table damages = damage_table(trials);
  if (!arguments.json.empty()) {
    write_report(arguments.json, {{"experiment", "map"}, {"rows", summary.json()}, {"damages", damages.json()}});
  }
  fmt::print("{}\n{}\n", damages.text(), summary.text());
  if (!trials.loops.empty()) {
    PoseGraphResult graph;
    graph.loops = trials.loops;
    const PoseGraphResult::Misclosure misclosure = graph.misclosure();
    fmt::print("Loops: {} of {} used; misclosure {:.2f} px before, {:.2f} px after.\n", graph.loops_used(),
               graph.loops.size(), misclosure.before_px, misclosure.after_px);
  }
  fmt::print("{}", map_note);
}

}  // namespace

void add_map_accuracy(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("map", "Maps of synthetic roads from several passes");
  const auto arguments = std::make_shared<MapArguments>();
  command->add_option("--roads", arguments->trials.roads, "Number of random roads")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--frames", arguments->trials.frames, "Frames of each of the three passes")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--seed", arguments->trials.seed, "Of the first road")->type_name("N")->capture_default_str();
  command->add_option("--memory-frames", arguments->memory_frames, "Frames of the test of memory")
      ->type_name("N")
      ->check(CLI::Range(10, 1'000'000))
      ->capture_default_str();
  command->add_option("--preset", arguments->trials.preset, "default, fast or paper")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--threads", arguments->trials.threads, "Worker threads; 0: all cores")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--estimated-poses", arguments->trials.estimated_poses,
                    "Take the poses of odometry, loops and positions with noise of 0.1 m instead of the true ones");
  add_json_option(*command, arguments->json);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli
