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

namespace roadstereo::cli {
namespace {

struct AblationArguments {
  AblationOptions options;
  std::string json;
};

/// Column of the table.
struct Measure {
  const char* heading;
  const char* key;  ///< in JSON
  double AblationResult::*member;
  double factor = 1;
  int decimals = 3;
  bool of_kitti = false;
};

constexpr double percent = 100;

const std::vector<Measure>& measures() {
  static const std::vector<Measure> all{
      {"KITTI density %", "kitti_density_percent", &AblationResult::kitti_density, percent, 1, true},
      {"KITTI e_r px", "kitti_e_r_px", &AblationResult::kitti_rms_px, 1, 3, true},
      {"KITTI e_p(2) %", "kitti_e_p_2px_percent", &AblationResult::kitti_bad, percent, 2, true},
      {"KITTI e_p+(2) %", "kitti_e_p_or_missing_2px_percent", &AblationResult::kitti_bad_or_missing, percent, 2, true},
      {"clean median px", "clean_median_error_px", &AblationResult::clean_median_px, 1, 4},
      {"clean e_p+(1) %", "clean_e_p_or_missing_1px_percent", &AblationResult::clean_bad_or_missing, percent, 2},
      {"hard e_p+(1) %", "hard_e_p_or_missing_1px_percent", &AblationResult::hard_bad_or_missing, percent, 2},
      {"damage e_r px", "damage_e_r_px", &AblationResult::damage_rms_px, 1, 3},
      {"damage e_p+(0.5) %", "damage_e_p_or_missing_0.5px_percent", &AblationResult::damage_bad_or_missing, percent, 2},
      {"match ms", "match_ms", &AblationResult::match_ms, 1, 1},
      {"total ms", "total_ms", &AblationResult::total_ms, 1, 1},
  };
  return all;
}

/// Value of a variant, with the difference from its preset in brackets.
std::string with_difference(const Measure& measure, const std::vector<AblationResult>& results, std::size_t variant) {
  const double value = measure.factor * results[variant].*measure.member;
  if (!std::isfinite(value)) return "–";
  std::string text = fmt::format("{:.{}f}", value, measure.decimals);
  const std::size_t base = base_of(variant);
  const double difference = value - measure.factor * results[base].*measure.member;
  return base == variant || std::isnan(difference) ? text
                                                   : fmt::format("{} ({:+.{}f})", text, difference, measure.decimals);
}

/// Table of the cells `cell(measure, variant)`.
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

void ablation(const AblationArguments& arguments) {
  const bool with_kitti = !arguments.options.kitti.empty();
  const std::vector<AblationResult> results = measure_ablation(arguments.options);
  const Table printed =
      ablation_table("Ablation; in brackets the difference from the preset", with_kitti,
                     [&](const Measure& measure, std::size_t i) { return Cell(with_difference(measure, results, i)); });
  fmt::print("{}", printed.text());
  fmt::print(
      "  KITTI: inside the road masks. clean, hard: rendered pairs without and with degradation; hard and damage are "
      "means\n"
      "  over the groups. e_p(x): share of the disparities with an error above x px; e_p+: missing disparities count "
      "as\n"
      "  errors, too. ms: medians over the {}; each pair is timed when it is matched a second time, with memory\n"
      "  allocated and the road model tracked\n",
      with_kitti ? "KITTI frames" : "clean rendered pairs");
  if (!arguments.json.empty()) {
    nlohmann::ordered_json variants = ablation_table("", with_kitti, [&](const Measure& measure, std::size_t i) {
                                        return Cell(measure.factor * results[i].*measure.member, measure.decimals);
                                      }).json();
    for (std::size_t i = 0; i < variants.size(); ++i) variants[i]["preset"] = ablation_variants()[i].preset;
    write_report(arguments.json, {{"variants", variants}});
  }
}

constexpr const char* ablation_footer =
    R"(Removes one component of the default preset at a time, removes components of the paper preset, and adds components of
the default preset to it. Options given with --set apply to every variant that does not set them itself.

Example:
  roadstereo evaluate ablation --kitti kitti2015 --json ablation.json)";

}  // namespace

void add_ablation(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("ablation", "Contribution of each component to accuracy and time");
  command->footer(ablation_footer);
  const auto arguments = std::make_shared<AblationArguments>();
  command->add_option("--kitti", arguments->options.kitti, "Folder with the layout of KITTI Stereo 2015 and road masks")
      ->type_name("DIR");
  add_synth_sizes(*command, arguments->options.sizes);
  add_method_options(*command, arguments->options.methods);
  add_json_option(*command, arguments->json);
  command->callback([arguments] { ablation(*arguments); });
}

}  // namespace roadstereo::cli
