#include <CLI/CLI.hpp>

#include "commands.hpp"
#include "evaluate/experiments.hpp"

namespace roadstereo::cli {
namespace {

constexpr const char* evaluate_footer =
    R"(Every experiment but paper, which writes a page, prints a table, with the published values where the paper has some.
--json writes the same values to a file; scripts/plot_evaluate.py draws those of ablation, blur, flatness, flight,
kitti, lambda, roll, runtime, sigma, subpixel and synth.

Example:
  roadstereo evaluate score disparity.tiff truth.png --tolerances 1,2,3 --figure error.png)";

}  // namespace

void add_evaluate(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("evaluate", "Accuracy against ground truth: the experiments of the paper and others");
  command->footer(evaluate_footer);
  command->require_subcommand(1);
  add_score(*command);
  add_paper(*command);
  add_kitti(*command);
  add_middlebury(*command);
  add_synth_accuracy(*command);
  add_sigma(*command);
  add_subpixel(*command);
  add_ablation(*command);
  add_lambda(*command);
  add_roll(*command);
  add_flatness(*command);
  add_blur(*command);
  add_damage_accuracy(*command);
  add_faults(*command);
  add_scan(*command);
  add_flight(*command);
  add_runtime(*command);
  add_odometry(*command);
  add_robustness(*command);
  add_map_accuracy(*command);
}

}  // namespace roadstereo::cli
