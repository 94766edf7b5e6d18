#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "evaluate/experiments.hpp"
#include "evaluate/methods.hpp"
#include "evaluate/report.hpp"
#include "evaluate/score_columns.hpp"
#include "evaluate/synth_figure.hpp"
#include "evaluate/synth_groups.hpp"

namespace roadstereo::cli {
namespace {

const std::vector<double>& tolerances_px() {
  static const std::vector<double> tolerances{0.5, 1};
  return tolerances;
}

struct Arguments {
  std::string sizes = "full";
  MethodSettings methods;
  ReportFiles report;
};

/// Means over the scenes of one group, by method.
struct GroupScores {
  std::vector<DisparityScore> whole;   ///< over what both cameras see
  std::vector<DisparityScore> damage;  ///< over the damage alone
};

/// Matches every scene of a group with every method; sub-pixel phases of the maps go to `biases`, one per method.
GroupScores score_group(const SynthGroup& group, const std::vector<synth::Scene>& scenes,
                        const MethodSettings& settings, std::vector<SubPixelBias>* biases) {
  const std::vector<std::string> names = method_names();
  std::vector<std::vector<DisparityScore>> whole(names.size()), damage(names.size());
  for (const synth::Scene& scene : scenes) {
    const SynthCase example = make_synth_case(group, scene, settings.threads);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Image<float> map = run_method(names[i], {example.pair, example.disparities}, settings);
      whole[i].push_back(score_disparity(map, example.truth, example.visible.view(), tolerances_px()));
      damage[i].push_back(score_disparity(map, example.truth, example.damage.view(), tolerances_px()));
      if (biases != nullptr) (*biases)[i].add(map, example.truth, example.visible);
    }
  }
  GroupScores means;
  for (std::size_t i = 0; i < names.size(); ++i) {
    means.whole.push_back(mean_score(whole[i]));
    means.damage.push_back(mean_score(damage[i]));
  }
  return means;
}

/// The figures that `index` is the best of the group in. Only e_r says nothing of missing disparities.
std::string best_in(const std::vector<DisparityScore>& group, std::size_t index) {
  const auto is_best = [&](const auto& figure) {
    for (const DisparityScore& other : group) {
      if (!(figure(group[index]) <= figure(other))) return false;
    }
    return true;
  };
  std::string text;
  for (std::size_t i = 0; i < tolerances_px().size(); ++i) {
    if (!is_best([i](const DisparityScore& score) { return score.bad_or_missing_share[i]; })) continue;
    text += (text.empty() ? "e_p+(" : ", e_p+(") + tolerance_text(tolerances_px()[i]) + ")";
  }
  if (is_best([](const DisparityScore& score) { return score.rms_px; })) text += text.empty() ? "e_r" : ", e_r";
  return text;
}

Table group_table(const std::string& title, const std::vector<std::vector<DisparityScore>>& groups) {
  Table table{title, {{"group", "group"}, {"method", "method"}}, {}};
  const auto columns = score_columns(tolerances_px());
  table.columns.insert(table.columns.end(), columns.begin(), columns.end());
  table.columns.push_back({"best in", "best_in"});
  const std::vector<std::string> names = method_names();
  for (std::size_t group = 0; group < groups.size(); ++group) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      std::vector<Cell> row{Cell(synth_groups()[group].name), Cell(names[i])};
      const std::vector<Cell> cells = score_cells(groups[group][i]);
      row.insert(row.end(), cells.begin(), cells.end());
      row.emplace_back(best_in(groups[group], i));
      table.rows.push_back(row);
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
  std::vector<SubPixelBias> biases(method_names().size());
  std::vector<std::vector<DisparityScore>> whole, damage;
  for (const SynthGroup& group : synth_groups()) {
    const bool clean = &group == &synth_groups().front();
    const GroupScores scores = score_group(group, scenes, arguments.methods, clean ? &biases : nullptr);
    whole.push_back(scores.whole);
    damage.push_back(scores.damage);
  }
  const Table everywhere = group_table(fmt::format("What both cameras see, mean over {} scenes", scenes.size()), whole);
  const Table on_damage = group_table("On damage alone", damage);
  const Table bias = bias_table(biases);
  fmt::print("{}\n{}\n{}\n{}", everywhere.text(), on_damage.text(), bias.text(), score_legend());
  if (!arguments.report.json.empty()) {
    write_report(arguments.report.json,
                 {{"visible", everywhere.json()}, {"damage", on_damage.json()}, {"sub_pixel_bias", bias.json()}});
  }
  if (!arguments.report.figure.empty()) {
    write_figure(arguments.report.figure, synth_figure(biases, {whole, damage}, tolerances_px()));
  }
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
