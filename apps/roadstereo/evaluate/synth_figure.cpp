#include "evaluate/synth_figure.hpp"

#include <algorithm>
#include <cmath>

#include "evaluate/methods.hpp"
#include "evaluate/score_columns.hpp"
#include "evaluate/synth_groups.hpp"
#include "roadstereo/io/picture_sheet.hpp"
#include "roadstereo/io/plot.hpp"

namespace roadstereo::cli {
namespace {

/// A matcher without pixel-locking stays within this band.
constexpr double flat_px = 0.03;

Frame bias_plot(const std::vector<SubPixelBias>& biases) {
  io::Panel panel{
      "Sub-pixel bias on clean pairs", "phase of the true disparity, px", "mean error, px", {}, false, false, {}, {}};
  panel.horizontal_lines = {-flat_px, 0, flat_px};
  double reach = 2 * flat_px;
  const std::vector<std::string> names = method_names();
  for (const char* shown : {"default", "SGBM"}) {
    const auto index = static_cast<std::size_t>(std::find(names.begin(), names.end(), shown) - names.begin());
    const std::vector<double> means = biases[index].means_px();
    for (const double mean : means) reach = std::fmax(reach, 1.1 * std::abs(mean));
    panel.curves.push_back({shown, biases[index].phases(), means, true, true});
  }
  panel.y_lowest = -reach;
  panel.y_highest = reach;
  return io::draw_plot({panel});
}

Frame group_bars(const std::string& title, const std::vector<std::vector<DisparityScore>>& groups,
                 std::size_t tolerance) {
  io::BarGroups bars{title, "e_p+, %", {}, method_names(), {}};
  bars.values.resize(bars.series.size());
  for (std::size_t group = 0; group < groups.size(); ++group) {
    bars.groups.push_back(synth_groups()[group].name);
    for (std::size_t i = 0; i < bars.series.size(); ++i) {
      constexpr double percent = 100;
      bars.values[i].push_back(percent * groups[group][i].bad_or_missing_share[tolerance]);
    }
  }
  constexpr int width = 1100;
  return io::draw_bars(bars, width);
}

}  // namespace

Frame synth_figure(const std::vector<SubPixelBias>& biases, const SynthScores& scores,
                   const std::vector<double>& tolerances_px) {
  std::vector<std::vector<Frame>> rows{{bias_plot(biases)}};
  for (std::size_t i = 0; i < tolerances_px.size(); ++i) {
    const std::string text = "in error by more than " + tolerance_text(tolerances_px[i]) + " px, or missing";
    rows.push_back(
        {group_bars("Both cameras see it: " + text, scores.whole, i), group_bars("Damage: " + text, scores.damage, i)});
  }
  return io::collage(rows);
}

}  // namespace roadstereo::cli
