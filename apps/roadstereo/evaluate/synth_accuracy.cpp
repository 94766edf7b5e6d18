#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "evaluate/baseline_comparison.hpp"
#include "evaluate/experiments.hpp"
#include "evaluate/methods.hpp"
#include "evaluate/pair_files.hpp"
#include "evaluate/report.hpp"
#include "evaluate/score_columns.hpp"
#include "evaluate/synth_groups.hpp"
#include "evaluate/synth_scores.hpp"
#include "json_text.hpp"

namespace roadstereo::cli {
namespace {

struct SynthAccuracyArguments {
  std::string sizes = "full";
  MethodSettings methods;
  std::string pairs_folder;  ///< of --write-pairs
  std::string json;
};

Table group_table(const std::string& title, const ScoresByGroup& groups, const std::vector<std::string>& names) {
  Table table{title, score_columns({{"group", "group"}, {"method", "method"}}, synth_tolerances_px()), {}};
  for (std::size_t group = 0; group < groups.size(); ++group) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      table.rows.push_back(score_cells({synth_groups()[group].name, names[i]}, groups[group][i]));
    }
  }
  return table;
}

Table bias_table(const std::vector<SubPixelBias>& biases, const std::vector<std::string>& names) {
  Table table{"Sub-pixel bias, clean pairs: peak-to-peak of the mean error over 20 phases of the true disparity",
              {{"method", "method"}, {"ripple px", "ripple_px"}},
              {}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    table.rows.push_back({Cell(names[i]), Cell(biases[i].ripple_px(), 4)});
  }
  return table;
}

/// Mean error by the phase of the true disparity, of every method.
nlohmann::ordered_json phases_json(const std::vector<SubPixelBias>& biases, const std::vector<std::string>& names) {
  nlohmann::ordered_json methods;
  for (std::size_t i = 0; i < names.size(); ++i) {
    nlohmann::ordered_json means = nlohmann::ordered_json::array();
    for (const double mean_px : biases[i].means_px()) means.push_back(json_number(mean_px));
    methods[names[i]] = {{"phase_px", biases[i].phases()}, {"mean_error_px", means}};
  }
  return methods;
}

void write_pairs(const std::vector<synth::Scene>& scenes, const SynthAccuracyArguments& arguments) {
  io::OutputFolder folder(arguments.pairs_folder);
  for (const SynthGroup& group : synth_groups()) {
    for (std::size_t scene = 0; scene < scenes.size(); ++scene) {
      add_pair(synth_frame(group, scene), make_synth_case(group, scenes[scene], arguments.methods.threads).pair,
               folder);
    }
  }
  folder.commit();
}

void synth_accuracy(const SynthAccuracyArguments& arguments) {
  const std::vector<synth::Scene> scenes = synth_scenes(arguments.sizes == "small");
  if (!arguments.pairs_folder.empty()) return write_pairs(scenes, arguments);
  const std::vector<std::string> names = method_names(arguments.methods);
  const SynthScores scores = score_synth(scenes, arguments.methods);
  const Table visible = group_table(fmt::format("Pixels that both cameras see, mean over {} scenes", scenes.size()),
                                    scores.visible, names);
  const Table damage = group_table("Pixels on damage", scores.damage, names);
  const Table common = group_table("Visible pixels with a disparity of every method except BM", scores.common, names);
  const Table common_damage =
      group_table("Pixels on damage with a disparity of every method except BM", scores.common_damage, names);
  const Table bias = bias_table(scores.biases, names);
  const BaselineComparison on_visible = compare_with_baselines("Visible pixels", scores.visible, scores.common);
  const BaselineComparison on_damage = compare_with_baselines("Pixels on damage", scores.damage, scores.common_damage);
  fmt::print("{}\n{}\n{}\n{}\n{}\n{}\n", visible.text(), damage.text(), common.text(), common_damage.text(),
             bias.text(), score_legend());
  fmt::print("{}\n{}\n{}\n{}\n", on_visible.table.text(), on_damage.table.text(), on_visible.summary,
             on_damage.summary);
  if (!arguments.json.empty()) {
    write_report(arguments.json, {{"visible", visible.json()},
                                  {"damage", damage.json()},
                                  {"common", common.json()},
                                  {"common_damage", common_damage.json()},
                                  {"sub_pixel_bias", bias.json()},
                                  {"sub_pixel_phases", phases_json(scores.biases, names)},
                                  {"best_visible", on_visible.table.json()},
                                  {"best_damage", on_damage.table.json()}});
  }
}

constexpr const char* synth_footer =
    R"(Rendered pairs with exact ground truth, in groups with one kind of degradation each. OpenCV's matchers get the same
pairs and search as many disparities as the ground truth needs; the left columns without a disparity count as missing.

Examples:
  roadstereo evaluate synth --sizes small --json synth.json
  roadstereo evaluate synth --write-pairs pairs      # match them, then
  roadstereo evaluate synth --maps mine=my_maps)";

}  // namespace

void add_synth_accuracy(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("synth", "Rendered roads with exact ground truth, clean and degraded");
  command->footer(synth_footer);
  const auto arguments = std::make_shared<SynthAccuracyArguments>();
  add_synth_sizes(*command, arguments->sizes);
  add_method_options(*command, arguments->methods);
  add_maps_option(*command, arguments->methods.maps);
  add_json_option(*command, arguments->json);
  add_write_pairs_option(*command, arguments->pairs_folder)->excludes("--set");
  command->callback([arguments] { synth_accuracy(*arguments); });
}

}  // namespace roadstereo::cli
