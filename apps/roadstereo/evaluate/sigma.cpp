#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "evaluate/experiments.hpp"
#include "evaluate/methods.hpp"
#include "evaluate/report.hpp"
#include "evaluate/sigma_calibration.hpp"
#include "evaluate/synth_groups.hpp"
#include "evaluate/table.hpp"

namespace roadstereo::cli {
namespace {

constexpr double percent = 100;
constexpr int bin_count = 10;

/// The share within 2σ that is aimed at: 0.954 of normal errors, with room for what matching cannot know of itself.
constexpr double min_within_2 = 0.90;
constexpr double max_within_2 = 0.97;

struct SigmaArguments {
  std::string preset = "default", sizes = "full";
  MethodSettings methods;
  std::string json;
};

/// Samples of all disparities with a ground truth.
struct Samples {
  std::vector<SigmaSample> visible;  ///< pixels that both cameras see
  std::vector<SigmaSample> damage;   ///< those on damage
};

void append(const std::vector<SigmaSample>& more, std::vector<SigmaSample>& all) {
  all.insert(all.end(), more.begin(), more.end());
}

Samples match_group(const SynthGroup& group, const std::vector<synth::Scene>& scenes, const SigmaArguments& arguments) {
  Samples samples;
  for (const synth::Scene& scene : scenes) {
    const SynthCase test_case = make_synth_case(group, scene, arguments.methods.threads);
    Pipeline pipeline(method_options(arguments.preset, {test_case.pair, test_case.disparities}, arguments.methods),
                      test_case.pair.calibration);
    const FrameResult& result = pipeline.process(test_case.pair.left.view(), test_case.pair.right.view());
    add_sigma_samples(result.disparity, result.sigma, test_case.truth, test_case.visible, samples.visible);
    add_sigma_samples(result.disparity, result.sigma, test_case.truth, test_case.damage, samples.damage);
  }
  return samples;
}

/// Calibration over one group of pairs.
struct SigmaGroup {
  std::string name;
  SigmaCalibration visible;  ///< over what both cameras see
  SigmaCalibration damage;   ///< over the damage alone
};

std::vector<Cell> calibration_row(const std::string& group, const char* pixels, const SigmaCalibration& calibration) {
  return {Cell(group),
          Cell(pixels),
          {static_cast<double>(calibration.pixels), 0},
          {percent * calibration.within_1, 1},
          {percent * calibration.within_2, 1},
          {calibration.median_error_px, 4},
          {calibration.median_sigma_px, 4}};
}

Table group_table(const std::vector<SigmaGroup>& groups) {
  Table table{"Standard errors against errors; for normal errors 68.3 % lie within σ and 95.4 % within 2σ",
              {{"group", "group"},
               {"where", "where"},
               {"pixels", "pixels"},
               {"< 1σ %", "within_1_sigma_percent"},
               {"< 2σ %", "within_2_sigma_percent"},
               {"median |error| px", "median_error_px"},
               {"median σ px", "median_sigma_px"}},
              {}};
  for (const SigmaGroup& group : groups) {
    table.rows.push_back(calibration_row(group.name, "visible", group.visible));
    table.rows.push_back(calibration_row(group.name, "damage", group.damage));
  }
  return table;
}

Table bin_table(const std::string& title, const std::vector<SigmaBin>& bins) {
  Table table{title,
              {{"σ px", "sigma_px"},
               {"p68 of |error| px", "p68_error_px"},
               {"rms error px", "rms_error_px"},
               {"< 2σ %", "within_2_sigma_percent"},
               {"pixels", "pixels"}},
              {}};
  for (const SigmaBin& bin : bins) {
    table.rows.push_back({{bin.sigma_px, 4},
                          {bin.p68_px, 4},
                          {bin.rms_px, 4},
                          {percent * bin.within_2, 1},
                          {static_cast<double>(bin.pixels), 0}});
  }
  return table;
}

std::string goal_line(const SigmaCalibration& all) {
  const char* outcome = "missed, no error is known";
  if (all.within_2 >= min_within_2) outcome = "met";
  if (all.within_2 < min_within_2) outcome = "missed, σ is too small";
  if (all.within_2 > max_within_2) outcome = "missed, σ is too large";
  return fmt::format("  goal: {:.0f}–{:.0f} % of all errors within 2σ; here {:.1f} %: {}\n", percent * min_within_2,
                     percent * max_within_2, percent * all.within_2, outcome);
}

void sigma(const SigmaArguments& arguments) {
  const std::vector<synth::Scene> scenes = synth_scenes(arguments.sizes == "small");
  Samples all;
  std::vector<SigmaGroup> groups;
  for (const SynthGroup& group : synth_groups()) {
    const Samples samples = match_group(group, scenes, arguments);
    groups.push_back({group.name, calibrate_sigma(samples.visible), calibrate_sigma(samples.damage)});
    append(samples.visible, all.visible);
    append(samples.damage, all.damage);
  }
  const SigmaGroup overall{"all", calibrate_sigma(all.visible), calibrate_sigma(all.damage)};
  groups.push_back(overall);
  const std::vector<SigmaBin> visible = sigma_bins(std::move(all.visible), bin_count);
  const std::vector<SigmaBin> damage = sigma_bins(std::move(all.damage), bin_count);
  const Table by_group = group_table(groups);
  const Table by_sigma = bin_table("Deciles by σ of the pixels that both cameras see", visible);
  const Table on_damage = bin_table("Deciles by σ of the pixels on damage", damage);
  fmt::print("{}\n{}\n{}\n{}", by_group.text(), by_sigma.text(), on_damage.text(), goal_line(overall.visible));
  if (!arguments.json.empty()) {
    write_report(arguments.json,
                 {{"groups", by_group.json()}, {"bins", by_sigma.json()}, {"damage_bins", on_damage.json()}});
  }
}

constexpr const char* sigma_footer =
    R"(Compares the standard errors of the disparities (sigma.tiff of inspect) with their true errors on the rendered pairs of
evaluate synth.

Example:
  roadstereo evaluate sigma --sizes small --json sigma.json)";

}  // namespace

void add_sigma(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("sigma", "Standard errors of the disparities against their true errors");
  command->footer(sigma_footer);
  const auto arguments = std::make_shared<SigmaArguments>();
  command->add_option("--preset", arguments->preset, "Preset: default, fast or paper")
      ->type_name("NAME")
      ->capture_default_str();
  add_synth_sizes(*command, arguments->sizes);
  add_method_options(*command, arguments->methods);
  add_json_option(*command, arguments->json);
  command->callback([arguments] { sigma(*arguments); });
}

}  // namespace roadstereo::cli
