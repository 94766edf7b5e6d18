#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "evaluate/experiments.hpp"
#include "evaluate/flatness_frames.hpp"
#include "evaluate/report.hpp"
#include "evaluate/roll_trials.hpp"
#include "evaluate/table.hpp"

namespace roadstereo::cli {
namespace {

constexpr double published_with_roll_px = 0.519;
constexpr double published_without_roll_px = 0.861;

struct FlatnessArguments {
  std::string data;
  std::string road_masks;
  std::string preset = "default";
  MethodSettings methods;
  std::string json;
};

constexpr const char* flatness_note =
    "The road regions of the paper were drawn by hand; masks derived from the ground truth exclude what is not flat. "
    "All\n"
    "valid disparities of the mask count, mismatches included. Least squares minimises σ_d by definition; the robust\n"
    "solver excludes outliers from the fit but not from σ_d.\n";

Flatness mean_of(const std::vector<FlatnessFrame>& frames, Flatness FlatnessFrame::*source) {
  Flatness mean;
  const auto count = static_cast<double>(frames.size());
  for (const FlatnessFrame& frame : frames) {
    const Flatness& one = frame.*source;
    mean.without_roll_px += one.without_roll_px / count;
    for (std::size_t i = 0; i < mean.with_roll_px.size(); ++i) mean.with_roll_px[i] += one.with_roll_px[i] / count;
  }
  return mean;
}

std::vector<Cell> row_of(const std::string& name, const char* disparities, const Flatness& flatness) {
  std::vector<Cell> row{name, disparities, Cell(flatness.without_roll_px, 3)};
  for (const double sigma : flatness.with_roll_px) row.emplace_back(sigma, 3);
  return row;
}

Table make_table(const std::vector<FlatnessFrame>& frames) {
  Table table{"σ_d of the transformed road, px",
              {{"frame", "frame"}, {"disparities", "disparities"}, {"ψ = 0", "without_roll_px"}},
              {}};
  for (const NamedSolver& solver : roll_solvers())
    table.columns.push_back({solver.name, std::string(solver.name) + "_px"});
  for (const FlatnessFrame& frame : frames) table.rows.push_back(row_of(frame.name, "truth", frame.truth));
  for (const FlatnessFrame& frame : frames) table.rows.push_back(row_of(frame.name, "matched", frame.matched));
  table.rows.push_back(row_of("mean", "truth", mean_of(frames, &FlatnessFrame::truth)));
  table.rows.push_back(row_of("mean", "matched", mean_of(frames, &FlatnessFrame::matched)));
  table.rows.push_back({"published: KITTI", "truth", Cell(published_without_roll_px, 3),
                        Cell(published_with_roll_px, 3), Cell(NAN, 3), Cell(NAN, 3)});
  return table;
}

void run(const FlatnessArguments& arguments) {
  preset(arguments.preset);  // throws now if there is no such preset
  std::vector<FlatnessFrame> frames;
  for (const KittiFiles& files : find_kitti_frames(arguments.data, arguments.road_masks)) {
    frames.push_back(measure_frame(files, arguments.preset, arguments.methods));
  }
  const Table table = make_table(frames);
  if (!arguments.json.empty()) {
    write_report(arguments.json, {{"experiment", "flatness"}, {"preset", arguments.preset}, {"rows", table.json()}});
  }
  fmt::print("{}\n{}", table.text(), flatness_note);
}

}  // namespace

void add_flatness(CLI::App& evaluate) {
  CLI::App* command =
      evaluate.add_subcommand("flatness", "σ_d of the transformed road with and without roll, on KITTI frames");
  const auto arguments = std::make_shared<FlatnessArguments>();
  command->add_option("DIR", arguments->data, "Folder of KITTI Stereo 2015 or 2012")->required();
  command
      ->add_option("--road-masks", arguments->road_masks,
                   "Folder of road masks, named like the frames, or polygons in JSON; default: DIR/road")
      ->type_name("DIR|FILE");
  command->add_option("--preset", arguments->preset, "Preset for matching")->type_name("NAME")->capture_default_str();
  add_method_options(*command, arguments->methods);
  command->footer("Example:\n  roadstereo evaluate flatness kitti2015 --json flatness.json");
  add_json_option(*command, arguments->json);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli
