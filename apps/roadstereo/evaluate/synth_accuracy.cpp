#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "evaluate/experiments.hpp"
#include "evaluate/methods.hpp"
#include "evaluate/report.hpp"
#include "evaluate/score_columns.hpp"
#include "evaluate/synth_figure.hpp"
#include "evaluate/synth_groups.hpp"
#include "evaluate/synth_scores.hpp"
#include "evaluate/synth_verdict.hpp"

namespace roadstereo::cli {
namespace {

struct Arguments {
  std::string sizes = "full";
  MethodSettings methods;
  ReportFiles report;
};

Table group_table(const std::string& title, const ScoresByGroup& groups) {
  Table table{title, {{"group", "group"}, {"method", "method"}}, {}};
  const auto columns = score_columns(synth_tolerances_px());
  table.columns.insert(table.columns.end(), columns.begin(), columns.end());
  const std::vector<std::string> names = method_names();
  for (std::size_t group = 0; group < groups.size(); ++group) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      table.rows.push_back({Cell(synth_groups()[group].name), Cell(names[i])});
      const std::vector<Cell> cells = score_cells(groups[group][i]);
      table.rows.back().insert(table.rows.back().end(), cells.begin(), cells.end());
    }
  }
  return table;
}

Table bias_table(const std::vector<SubPixelBias>& biases) {
  Table table{"Sub-pixel bias, clean pairs: largest less smallest mean error over 20 phases of the truth",
              {{"method", "method"}, {"ripple px", "ripple_px"}},
              {}};
  const std::vector<std::string> names = method_names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    table.rows.push_back({Cell(names[i]), Cell(biases[i].ripple_px(), 4)});
  }
  return table;
}

void synth_accuracy(const Arguments& arguments) {
  const std::vector<synth::Scene> scenes = synth_scenes(arguments.sizes == "small");
  const SynthScores scores = score_synth(scenes, arguments.methods);
  const Table visible =
      group_table(fmt::format("What both cameras see, mean over {} scenes", scenes.size()), scores.visible);
  const Table damage = group_table("On damage alone", scores.damage);
  const Table common = group_table("What both cameras see and every method but BM gives", scores.common);
  const Table common_damage = group_table("Damage that every method but BM gives", scores.common_damage);
  const Table bias = bias_table(scores.biases);
  const SynthVerdict everywhere = judge_default("What both cameras see", scores.visible, scores.common);
  const SynthVerdict on_damage = judge_default("Damage", scores.damage, scores.common_damage);
  fmt::print("{}\n{}\n{}\n{}\n{}\n{}\n", visible.text(), damage.text(), common.text(), common_damage.text(),
             bias.text(), score_legend());
  fmt::print("{}\n{}\n{}\n{}\n", everywhere.table.text(), on_damage.table.text(), everywhere.summary,
             on_damage.summary);
  if (!arguments.report.json.empty()) {
    write_report(arguments.report.json, {{"visible", visible.json()},
                                         {"damage", damage.json()},
                                         {"common", common.json()},
                                         {"common_damage", common_damage.json()},
                                         {"sub_pixel_bias", bias.json()},
                                         {"best_visible", everywhere.table.json()},
                                         {"best_damage", on_damage.table.json()}});
  }
  if (!arguments.report.figure.empty()) write_figure(arguments.report.figure, synth_figure(scores));
}

constexpr const char* synth_footer =
    R"(Rendered pairs with exact truth, in groups that each have one thing that spoils a pair. OpenCV's matchers get the same
pairs and as many disparities as the truth needs; the columns that they leave out for it count as missing.

Example:
  roadstereo evaluate synth --sizes small --figure synth.png)";

}  // namespace

void add_synth_accuracy(CLI::App& evaluate) {
  CLI::App* command = evaluate.add_subcommand("synth", "Rendered roads with exact truth, clean and spoilt");
  command->footer(synth_footer);
  const auto arguments = std::make_shared<Arguments>();
  add_synth_sizes(*command, arguments->sizes);
  add_method_options(*command, arguments->methods);
  add_report_options(*command, arguments->report);
  command->callback([arguments] { synth_accuracy(*arguments); });
}

}  // namespace roadstereo::cli
