#include "evaluate/score_columns.hpp"

#include <fmt/core.h>

namespace roadstereo::cli {

std::string tolerance_text(double tolerance_px) {
  return fmt::format("{:g}", tolerance_px);
}

std::vector<Column> score_columns(const std::vector<double>& tolerances_px) {
  std::vector<Column> columns{{"e_r px", "e_r_px"}, {"bias px", "mean_error_px"}, {"median px", "median_error_px"}};
  for (const double tolerance : tolerances_px) {
    const std::string text = tolerance_text(tolerance);
    columns.push_back({"e_p(" + text + ") %", "e_p_" + text + "px_percent"});
  }
  columns.push_back({"density %", "density_percent"});
  for (const double tolerance : tolerances_px) {
    const std::string text = tolerance_text(tolerance);
    columns.push_back({"e_p(" + text + ")+missing %", "e_p_or_missing_" + text + "px_percent"});
  }
  return columns;
}

std::vector<Cell> score_cells(const DisparityScore& score) {
  constexpr double percent = 100;
  std::vector<Cell> cells{{score.rms_px, 3}, {score.mean_px, 3}, {score.median_px, 3}};
  for (const double share : score.bad_share) cells.emplace_back(percent * share, 3);
  cells.emplace_back(percent * score.density(), 2);
  for (const double share : score.bad_or_missing_share) cells.emplace_back(percent * share, 3);
  return cells;
}

}  // namespace roadstereo::cli
