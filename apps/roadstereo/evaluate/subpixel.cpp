#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "evaluate/experiments.hpp"
#include "evaluate/methods.hpp"
#include "evaluate/report.hpp"
#include "evaluate/subpixel_trials.hpp"
#include "evaluate/table.hpp"
#include "json_text.hpp"

namespace roadstereo::cli {
namespace {

constexpr double percent = 100;
constexpr double max_bias_px = 0.01, max_ratio = 1.5;  // goals of the default preset

struct SubPixelArguments {
  int roads = 6;
  MethodSettings methods;
  std::string json;
};

double largest_bias_px(const SubPixelBias& bias) {
  double largest = std::numeric_limits<double>::quiet_NaN();
  for (const double mean : bias.means_px()) largest = std::fmax(largest, std::abs(mean));
  return largest;
}

Table subpixel_table(const std::vector<SubPixelTrial>& trials) {
  Table table{"Errors by sub-pixel phase, and random errors against the Cramér–Rao bound of the window",
              {{"noise grey", "noise_grey"},
               {"method", "method"},
               {"valid %", "valid_percent"},
               {"max |bias| px", "max_bias_px"},
               {"ripple px", "ripple_px"},
               {"noise px", "noise_px"},
               {"window px", "support_px"},
               {"bound px", "bound_px"},
               {"noise / bound", "ratio"}},
              {}};
  for (const SubPixelTrial& trial : trials) {
    table.rows.push_back({{trial.noise_grey, 0},
                          Cell(trial.method),
                          {percent * trial.valid_share, 1},
                          {largest_bias_px(trial.bias), 4},
                          {trial.bias.ripple_px(), 4},
                          {trial.noise.noise_px(), 4},
                          {trial.noise.support_px(), 1},
                          {trial.noise.bound_px(), 4},
                          {trial.noise.ratio(), 2}});
  }
  return table;
}

nlohmann::ordered_json phases_json(const std::vector<SubPixelTrial>& trials) {
  nlohmann::ordered_json phases = nlohmann::ordered_json::array();
  for (const SubPixelTrial& trial : trials) {
    nlohmann::ordered_json means = nlohmann::ordered_json::array();
    for (const double mean_px : trial.bias.means_px()) means.push_back(json_number(mean_px));
    phases.push_back({{"noise_grey", trial.noise_grey},
                      {"method", trial.method},
                      {"phase_px", trial.bias.phases()},
                      {"mean_error_px", means}});
  }
  return phases;
}

std::string goal_line(const std::vector<SubPixelTrial>& trials) {
  double bias = 0, ratio = 0;
  const auto worse = [](double one, double other) { return one >= other || std::isnan(one) ? one : other; };
  for (const SubPixelTrial& trial : trials) {
    if (trial.method != "default") continue;
    bias = worse(bias, largest_bias_px(trial.bias));
    ratio = worse(ratio, trial.noise.ratio());
  }
  const auto outcome = [](bool met) { return met ? "met" : "missed"; };
  return fmt::format(
      "  goals of default: bias within ±{} px; here {:.4f}: {}; noise at most {} times its bound; here {:.2f}: {}\n",
      max_bias_px, bias, outcome(bias <= max_bias_px), max_ratio, ratio, outcome(ratio <= max_ratio));
}

void subpixel(const SubPixelArguments& arguments) {
  const std::vector<SubPixelTrial> trials = measure_subpixel(arguments.roads, {1, 2, 4}, arguments.methods);
  const Table table = subpixel_table(trials);
  fmt::print("{}\n{}", table.text(), goal_line(trials));
  if (!arguments.json.empty()) {
    write_report(arguments.json, {{"methods", table.json()}, {"phases", phases_json(trials)}});
  }
}

constexpr const char* subpixel_footer =
    R"(Two shots each of roads in closed form, which differ in the noise of the cameras alone. Bias: mean error over 20 phases
of the disparity that a method fits, in the transformed pair for the presets. Noise: from the difference of both shots.
Window: side of the square over which errors are correlated, which the map averages over. Bound: the least standard
deviation that any unbiased estimate over that window can have.

Example:
  roadstereo evaluate subpixel --roads 2 --json subpixel.json)";

}  // namespace

void add_subpixel(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("subpixel", "Sub-pixel bias, and noise against the Cramér–Rao bound");
  command->footer(subpixel_footer);
  const auto arguments = std::make_shared<SubPixelArguments>();
  command->add_option("--roads", arguments->roads, "Number of roads")
      ->type_name("N")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_method_options(*command, arguments->methods);
  add_json_option(*command, arguments->json);
  command->callback([arguments] { subpixel(*arguments); });
}

}  // namespace roadstereo::cli
