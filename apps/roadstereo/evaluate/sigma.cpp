#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "evaluate/experiments.hpp"
#include "evaluate/methods.hpp"
#include "evaluate/report.hpp"
#include "evaluate/sigma_figure.hpp"
#include "evaluate/synth_groups.hpp"
#include "evaluate/table.hpp"

namespace roadstereo::cli {
namespace {

constexpr double percent = 100;
constexpr int bin_count = 10;

struct Arguments {
  std::string preset = "default", sizes = "full";
  MethodSettings methods;
  ReportFiles report;
};

/// Every disparity with a truth.
struct Claims {
  std::vector<ClaimedError> visible;  ///< what both cameras see
  std::vector<ClaimedError> damage;   ///< the damage alone
};

void append(const std::vector<ClaimedError>& more, std::vector<ClaimedError>& all) {
  all.insert(all.end(), more.begin(), more.end());
}

Claims match_group(const SynthGroup& group, const std::vector<synth::Scene>& scenes, const Arguments& arguments) {
  Claims claims;
  for (const synth::Scene& scene : scenes) {
    const SynthCase example = make_synth_case(group, scene, arguments.methods.threads);
    Pipeline pipeline(method_options(arguments.preset, {example.pair, example.disparities}, arguments.methods),
                      example.pair.calibration);
    const FrameResult& result = pipeline.process(example.pair.left.view(), example.pair.right.view());
    add_claimed_errors(result.disparity, result.sigma, example.truth, example.visible, claims.visible);
    add_claimed_errors(result.disparity, result.sigma, example.truth, example.damage, claims.damage);
  }
  return claims;
}

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
  Table table{"Standard errors against errors; of normal errors 68.3 % lie within σ and 95.4 % within 2σ",
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
  const char* outcome = "met";
  if (all.within_2 < least_within_2) outcome = "missed, they promise too much";
  if (all.within_2 > most_within_2) outcome = "missed, they are wider than need be";
  return fmt::format("  goal: {:.0f}–{:.0f} % of all errors within 2σ; here {:.1f} %: {}\n", percent * least_within_2,
                     percent * most_within_2, percent * all.within_2, outcome);
}

void sigma(const Arguments& arguments) {
  const std::vector<synth::Scene> scenes = synth_scenes(arguments.sizes == "small");
  Claims all;
  std::vector<SigmaGroup> groups;
  for (const SynthGroup& group : synth_groups()) {
    const Claims claims = match_group(group, scenes, arguments);
    groups.push_back({group.name, calibrate_sigma(claims.visible), calibrate_sigma(claims.damage)});
    append(claims.visible, all.visible);
    append(claims.damage, all.damage);
  }
  const SigmaGroup overall{"all", calibrate_sigma(all.visible), calibrate_sigma(all.damage)};
  groups.push_back(overall);
  const std::vector<SigmaBin> visible = sigma_bins(std::move(all.visible), bin_count);
  const std::vector<SigmaBin> damage = sigma_bins(std::move(all.damage), bin_count);
  const Table by_group = group_table(groups);
  const Table by_sigma = bin_table("Tenths of the pixels that both cameras see, by σ", visible);
  const Table on_damage = bin_table("Tenths of the damage", damage);
  fmt::print("{}\n{}\n{}\n{}", by_group.text(), by_sigma.text(), on_damage.text(), goal_line(overall.visible));
  if (!arguments.report.json.empty()) {
    write_report(arguments.report.json,
                 {{"groups", by_group.json()}, {"bins", by_sigma.json()}, {"damage_bins", on_damage.json()}});
  }
  if (!arguments.report.figure.empty()) write_figure(arguments.report.figure, sigma_figure(visible, damage, groups));
}

constexpr const char* sigma_footer =
    R"(Whether the standard error of every disparity (sigma.tiff of inspect) keeps what it promises: the rendered pairs of
evaluate synth, whose errors are known.

Example:
  roadstereo evaluate sigma --sizes small --figure sigma.png)";

}  // namespace

void add_sigma(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("sigma", "Standard errors of the disparities against their true errors");
  command->footer(sigma_footer);
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("--preset", arguments->preset, "Whose disparities: default, fast or paper")
      ->type_name("NAME")
      ->capture_default_str();
  add_synth_sizes(*command, arguments->sizes);
  add_method_options(*command, arguments->methods);
  add_report_options(*command, arguments->report);
  command->callback([arguments] { sigma(*arguments); });
}

}  // namespace roadstereo::cli
