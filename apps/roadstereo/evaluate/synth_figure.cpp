#include "evaluate/synth_figure.hpp"

#include <cmath>

#include "evaluate/bar_reach.hpp"
#include "evaluate/methods.hpp"
#include "evaluate/score_columns.hpp"
#include "evaluate/synth_groups.hpp"
#include "roadstereo/io/picture_sheet.hpp"
#include "roadstereo/io/plot.hpp"

namespace roadstereo::cli {
namespace {

/// A matcher without pixel-locking stays within this band.
constexpr double flat_px = 0.03;
constexpr double percent = 100;

Frame bias_plot(const std::vector<SubPixelBias>& biases) {
  io::Panel panel{
      "Sub-pixel bias on clean pairs", "phase of the true disparity, px", "mean error, px", {}, false, false, {}, {}};
  panel.horizontal_lines = {-flat_px, 0, flat_px};
  double reach = 2 * flat_px;
  for (const char* shown : {"default", "SGBM"}) {
    const std::size_t index = method_index(shown);
    const std::vector<double> means = biases[index].means_px();
    for (const double mean : means) reach = std::fmax(reach, 1.1 * std::abs(mean));
    panel.curves.push_back({shown, biases[index].phases(), means, true, true});
  }
  panel.y_lowest = -reach;
  panel.y_highest = reach;
  return io::draw_plot({panel});
}

Frame group_bars(const std::string& title, const ScoresByGroup& groups, std::size_t tolerance) {
  io::BarGroups bars{title + "; cut bars carry their value", "e_p+, %", {}, method_names(), {}};
  bars.values.resize(bars.series.size());
  for (std::size_t group = 0; group < groups.size(); ++group) {
    bars.groups.push_back(synth_groups()[group].name);
    for (std::size_t i = 0; i < bars.series.size(); ++i) {
      bars.values[i].push_back(percent * groups[group][i].bad_or_missing_share[tolerance]);
    }
  }
  bars.y_highest = reach_without_bm(bars);
  constexpr int width = 1100;
  return io::draw_bars(bars, width);
}

}  // namespace

Frame synth_figure(const SynthScores& scores) {
  std::vector<std::vector<Frame>> rows{{bias_plot(scores.biases)}};
  for (std::size_t i = 0; i < synth_tolerances_px().size(); ++i) {
    const std::string text = "in error by more than " + tolerance_text(synth_tolerances_px()[i]) + " px, or missing";
    rows.push_back({group_bars("Both cameras see it: " + text, scores.visible, i),
                    group_bars("Damage: " + text, scores.damage, i)});
  }
  return io::collage(rows);
}

}  // namespace roadstereo::cli
