#include "evaluate/score_columns.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

namespace roadstereo::cli {
namespace {

/// Mean of the finite values; NaN if there is none.
template <class Value>
double mean_of(const std::vector<DisparityScore>& scores, const Value& value_of) {
  double sum = 0, count = 0;
  for (const DisparityScore& score : scores) {
    const double value = value_of(score);
    if (!std::isfinite(value)) continue;
    sum += value;
    count += 1;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

/// "0.5", "3".
std::string tolerance_text(double tolerance_px) {
  return fmt::format("{:g}", tolerance_px);
}

}  // namespace

std::vector<Column> score_columns(std::vector<Column> columns, const std::vector<double>& tolerances_px) {
  columns.insert(
      columns.end(),
      {{"e_r px", "e_r_px"}, {"bias px", "mean_error_px"}, {"sd px", "error_sd_px"}, {"median px", "median_error_px"}});
  for (const double tolerance : tolerances_px) {
    const std::string text = tolerance_text(tolerance);
    columns.push_back({"e_p(" + text + ") %", "e_p_" + text + "px_percent"});
  }
  columns.push_back({"density %", "density_percent"});
  for (const double tolerance : tolerances_px) {
    const std::string text = tolerance_text(tolerance);
    columns.push_back({"e_p+(" + text + ") %", "e_p_or_missing_" + text + "px_percent"});
  }
  return columns;
}

std::vector<Cell> score_cells(std::vector<Cell> cells, const DisparityScore& score) {
  constexpr double percent = 100;
  for (const double error : {score.rms_px, score.mean_px, score.sd_px, score.median_px}) cells.emplace_back(error, 3);
  for (const double share : score.bad_share) cells.emplace_back(percent * share, 3);
  cells.emplace_back(percent * score.density, 2);
  for (const double share : score.bad_or_missing_share) cells.emplace_back(percent * share, 3);
  return cells;
}

std::string score_legend() {
  return "  e_p(x): share of the disparities with an error above x px; e_p+: missing disparities count as errors, "
         "too\n";
}

DisparityScore mean_score(const std::vector<DisparityScore>& scores) {
  DisparityScore mean;
  mean.density = mean_of(scores, [](const DisparityScore& score) {
    return score.labelled_pixels > 0 ? score.density : std::numeric_limits<double>::quiet_NaN();
  });
  mean.rms_px = mean_of(scores, [](const DisparityScore& score) { return score.rms_px; });
  mean.mean_px = mean_of(scores, [](const DisparityScore& score) { return score.mean_px; });
  mean.sd_px = mean_of(scores, [](const DisparityScore& score) { return score.sd_px; });
  mean.median_px = mean_of(scores, [](const DisparityScore& score) { return score.median_px; });
  const std::size_t tolerances = scores.empty() ? 0 : scores.front().bad_share.size();
  for (std::size_t i = 0; i < tolerances; ++i) {
    mean.bad_share.push_back(mean_of(scores, [i](const DisparityScore& score) { return score.bad_share[i]; }));
    mean.bad_or_missing_share.push_back(
        mean_of(scores, [i](const DisparityScore& score) { return score.bad_or_missing_share[i]; }));
  }
  return mean;
}

}  // namespace roadstereo::cli
