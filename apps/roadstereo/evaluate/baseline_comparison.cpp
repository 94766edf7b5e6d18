#include "evaluate/baseline_comparison.hpp"

#include <fmt/core.h>

#include <cmath>

#include "evaluate/score_columns.hpp"
#include "evaluation/peer_matchers.hpp"

namespace roadstereo::cli {
namespace {

/// Measure that is compared; smaller is better.
struct Measure {
  Column column;
  double (*value)(const DisparityScore& score);
  int decimals;
  bool on_common_pixels;
};

const std::vector<Measure>& measures() {
  constexpr double percent = 100;
  static const std::vector<Measure> all{
      {{"e_p+(0.5) %", "e_p_or_missing_0.5px"},
       [](const DisparityScore& score) { return percent * score.bad_or_missing_share[0]; },
       3,
       false},
      {{"e_p+(1) %", "e_p_or_missing_1px"},
       [](const DisparityScore& score) { return percent * score.bad_or_missing_share[1]; },
       3,
       false},
      {{"e_r px", "e_r"}, [](const DisparityScore& score) { return score.rms_px; }, 3, false},
      {{"e_r px, common pixels", "e_r_common"}, [](const DisparityScore& score) { return score.rms_px; }, 3, true},
  };
  return all;
}

/// "best", or the best baseline with its value and that of the default preset; "–" where that has none.
std::string outcome(const Measure& measure, const std::vector<DisparityScore>& scores) {
  const double ours = measure.value(scores[method_index("default")]);
  if (std::isnan(ours)) return "–";
  std::string best_baseline;
  double best = ours;
  for (const std::string& baseline : io::peer_names()) {
    const double value = measure.value(scores[method_index(baseline)]);
    if (!(value < best)) continue;
    best = value;
    best_baseline = baseline;
  }
  if (best_baseline.empty()) return "best";
  return fmt::format("{} {:.{}f} against {:.{}f}", best_baseline, best, measure.decimals, ours, measure.decimals);
}

}  // namespace

BaselineComparison compare_with_baselines(const std::string& pixels, const ScoresByGroup& scores,
                                          const ScoresByGroup& common) {
  BaselineComparison comparison{{"Default preset against OpenCV's matchers: " + pixels, {{"group", "group"}}, {}}, ""};
  std::vector<std::size_t> best_count(measures().size(), 0);
  std::size_t best_in_all_count = 0;
  for (const Measure& measure : measures()) comparison.table.columns.push_back(measure.column);
  for (std::size_t group = 0; group < scores.size(); ++group) {
    comparison.table.rows.push_back({Cell(synth_groups()[group].name)});
    bool best_in_all = true;
    for (std::size_t i = 0; i < measures().size(); ++i) {
      const std::string text = outcome(measures()[i], (measures()[i].on_common_pixels ? common : scores)[group]);
      best_count[i] += text == "best" ? 1 : 0;
      best_in_all = best_in_all && text == "best";
      comparison.table.rows.back().emplace_back(text);
    }
    best_in_all_count += best_in_all ? 1 : 0;
  }
  comparison.summary =
      fmt::format("{}: best in {} of {} groups by all measures;", pixels, best_in_all_count, scores.size());
  for (std::size_t i = 0; i < best_count.size(); ++i) {
    comparison.summary += fmt::format("{} {}: {}", i == 0 ? "" : ",", measures()[i].column.heading, best_count[i]);
  }
  return comparison;
}

}  // namespace roadstereo::cli
