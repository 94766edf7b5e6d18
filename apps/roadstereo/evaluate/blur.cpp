#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "evaluate/blur_trials.hpp"
#include "evaluate/experiments.hpp"
#include "evaluate/report.hpp"
#include "evaluate/table.hpp"

namespace roadstereo::cli {
namespace {

struct BlurArguments {
  BlurOptions trials;
  std::string json;
};

constexpr const char* blur_note =
    "Means over the directions, over the pixels that both cameras see. SGBM gets the pair as transformed by the "
    "default\n"
    "preset; without it SGBM has no disparity in the leftmost columns. The paper shows blurred frames but no "
    "numbers.\n";

constexpr double percent = 100;

Table make_table(const std::vector<BlurTrial>& trials, const BlurOptions& options) {
  Table table{fmt::format("Motion blur, scene {}, noise {} grey levels", options.scene, options.noise_grey),
              {{"method", "method"},
               {"length px", "length_px"},
               {"density %", "density_percent"},
               {"e_r px", "rms_px"},
               {"e_p+(1) %", "e_p_or_missing_1px_percent"}},
              {}};
  for (const std::string& method : blur_methods()) {
    for (const double length : blur_lengths(options)) {
      const BlurTrial mean = mean_over_directions(trials, method, length);
      table.rows.push_back({method, Cell(length, 1), Cell(percent * mean.density, 1), Cell(mean.rms_px, 3),
                            Cell(percent * mean.bad_or_missing, 1)});
    }
  }
  return table;
}

nlohmann::ordered_json trials_json(const std::vector<BlurTrial>& trials) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const BlurTrial& trial : trials) {
    all.push_back({{"method", trial.method},
                   {"length_px", trial.length_px},
                   {"direction_deg", trial.direction_deg},
                   {"density", trial.density},
                   {"rms_px", trial.rms_px},
                   {"bad_or_missing", trial.bad_or_missing}});
  }
  return all;
}

void run(const BlurArguments& arguments) {
  const std::vector<BlurTrial> trials = run_blur_trials(arguments.trials);
  const Table table = make_table(trials, arguments.trials);
  if (!arguments.json.empty()) {
    write_report(arguments.json, {{"experiment", "blur"}, {"rows", table.json()}, {"trials", trials_json(trials)}});
  }
  fmt::print("{}\n{}", table.text(), blur_note);
}

}  // namespace

void add_blur(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("blur", "Density and error against motion blur, on synthetic roads");
  const auto arguments = std::make_shared<BlurArguments>();
  BlurOptions& trials = arguments->trials;
  command->add_option("--scene", trials.scene, "Name of the scene")->type_name("NAME")->capture_default_str();
  command->add_option("--max-length", trials.max_px, "Maximum length of the motion")
      ->type_name("PX")
      ->capture_default_str();
  command->add_option("--steps", trials.steps, "Number of lengths from 0 to the maximum")->capture_default_str();
  command->add_option("--directions", trials.directions_deg, "Directions of the motion; 0 is along the rows")
      ->type_name("DEG,…")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--noise", trials.noise_grey, "Standard deviation of the noise, 8-bit grey levels")
      ->type_name("GREY")
      ->capture_default_str();
  add_method_options(*command, trials.methods);
  command->footer("Example:\n  roadstereo evaluate blur --scene street --directions 0,90 --json blur.json");
  add_json_option(*command, arguments->json);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace roadstereo::cli
