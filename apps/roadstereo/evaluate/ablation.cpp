#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "evaluate/ablation_trials.hpp"
#include "evaluate/ablation_variants.hpp"
#include "evaluate/experiments.hpp"
#include "evaluate/report.hpp"
#include "evaluate/synth_groups.hpp"
#include "evaluate/table.hpp"
#include "roadstereo/io/bar_table.hpp"

namespace roadstereo::cli {
namespace {

struct Arguments {
  AblationOptions options;
  ReportFiles report;
};

/// A figure of a variant as table, JSON and picture spell it.
struct Measure {
  const char* heading;
  const char* key;
  double AblationFigures::*figure;
  double factor = 1;
  int decimals = 3;
  bool of_kitti = false;
};

constexpr double percent = 100;

const std::vector<Measure>& measures() {
  static const std::vector<Measure> all{
      {"KITTI density %", "kitti_density_percent", &AblationFigures::kitti_density, percent, 1, true},
      {"KITTI e_r px", "kitti_e_r_px", &AblationFigures::kitti_rms_px, 1, 3, true},
      {"KITTI e_p(2) %", "kitti_e_p_2px_percent", &AblationFigures::kitti_bad, percent, 2, true},
      {"KITTI e_p+(2) %", "kitti_e_p_or_missing_2px_percent", &AblationFigures::kitti_bad_or_missing, percent, 2, true},
      {"clean median px", "clean_median_error_px", &AblationFigures::clean_median_px, 1, 4},
      {"clean e_p+(1) %", "clean_e_p_or_missing_1px_percent", &AblationFigures::clean_bad_or_missing, percent, 2},
      {"hard e_p+(1) %", "hard_e_p_or_missing_1px_percent", &AblationFigures::hard_bad_or_missing, percent, 2},
      {"damage e_r px", "damage_e_r_px", &AblationFigures::damage_rms_px, 1, 3},
      {"damage e_p+(0.5) %", "damage_e_p_or_missing_0.5px_percent", &AblationFigures::damage_bad_or_missing, percent,
       2},
      {"match ms", "match_ms", &AblationFigures::match_ms, 1, 1},
      {"total ms", "total_ms", &AblationFigures::total_ms, 1, 1},
  };
  return all;
}

/// A figure, with the difference to the preset it starts from in brackets.
std::string with_difference(const Measure& measure, const std::vector<AblationFigures>& figures, std::size_t variant) {
  const double value = measure.factor * figures[variant].*measure.figure;
  if (!std::isfinite(value)) return "–";
  std::string text = fmt::format("{:.{}f}", value, measure.decimals);
  const std::size_t base = base_of(variant);
  if (base == variant) return text;
  return fmt::format("{} ({:+.{}f})", text, value - measure.factor * figures[base].*measure.figure, measure.decimals);
}

/// Rows of cells that `cell(measure, variant)` makes.
template <class MakeCell>
Table ablation_table(const std::string& title, bool with_kitti, const MakeCell& cell) {
  Table table{title, {{"variant", "variant"}}, {}};
  for (const Variant& variant : ablation_variants()) table.rows.push_back({Cell(variant.name)});
  for (const Measure& measure : measures()) {
    if (measure.of_kitti && !with_kitti) continue;
    table.columns.push_back({measure.heading, measure.key});
    for (std::size_t i = 0; i < table.rows.size(); ++i) table.rows[i].push_back(cell(measure, i));
  }
  return table;
}

Frame ablation_figure(const std::vector<AblationFigures>& figures, bool with_kitti) {
  io::BarTable table{
      "What each idea buys. Blue: the preset; green better, orange worse, grey within 3 % of it. Each preset has its "
      "scale",
      {},
      {},
      {}};
  for (std::size_t i = 0; i < figures.size(); ++i) {
    table.rows.push_back(ablation_variants()[i].name);
    table.bases.push_back(base_of(i));
  }
  for (const Measure& measure : measures()) {
    // More density is better, and is part of e_p+.
    if ((measure.of_kitti && !with_kitti) || measure.figure == &AblationFigures::kitti_density) continue;
    io::BarColumn column{measure.heading, {}, measure.decimals};
    for (const AblationFigures& of_variant : figures)
      column.values.push_back(measure.factor * of_variant.*measure.figure);
    table.columns.push_back(column);
  }
  return io::draw_bar_table(table);
}

void ablation(const Arguments& arguments) {
  const bool with_kitti = !arguments.options.kitti.empty();
  const std::vector<AblationFigures> figures = measure_ablation(arguments.options);
  const Table printed =
      ablation_table("What each idea buys, and in brackets the difference to the preset as it is", with_kitti,
                     [&](const Measure& measure, std::size_t i) { return Cell(with_difference(measure, figures, i)); });
  fmt::print("{}", printed.text());
  fmt::print(
      "  KITTI: road masks. clean, hard: rendered pairs unspoilt and spoilt, hard and damage means over the groups.\n"
      "  e_p: disparities in error by more than so many px; e_p+: missing disparities counted as errors, too.\n"
      "  ms: median over the {}, each pair matched a second time: memory there, road model carried over\n",
      with_kitti ? "KITTI frames" : "clean rendered pairs");
  if (!arguments.report.json.empty()) {
    const Table bare = ablation_table("", with_kitti, [&](const Measure& measure, std::size_t i) {
      return Cell(measure.factor * figures[i].*measure.figure, measure.decimals);
    });
    write_report(arguments.report.json, {{"variants", bare.json()}});
  }
  if (!arguments.report.figure.empty()) write_figure(arguments.report.figure, ablation_figure(figures, with_kitti));
}

constexpr const char* ablation_footer =
    R"(Takes the ideas of the default preset away one at a time, takes the paper's own away from the paper preset, and adds
ours to it. Options given with --set hold for every variant that does not set them itself.

Example:
  roadstereo evaluate ablation --kitti kitti2015 --figure ablation.png)";

}  // namespace

void add_ablation(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("ablation", "What each idea buys, in accuracy and in time");
  command->footer(ablation_footer);
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("--kitti", arguments->options.kitti, "Folder laid out as KITTI Stereo 2015, with road masks")
      ->type_name("DIR");
  add_synth_sizes(*command, arguments->options.sizes);
  add_method_options(*command, arguments->options.methods);
  add_report_options(*command, arguments->report);
  command->callback([arguments] { ablation(*arguments); });
}

}  // namespace roadstereo::cli
