#pragma once

#include <vector>

#include "evaluate/table.hpp"
#include "roadstereo/disparity_score.hpp"

namespace roadstereo::cli {

/// A tolerance as headings and keys spell it: "0.5", "3".
std::string tolerance_text(double tolerance_px);

/// Headings of score_cells: e_r, bias, median, e_p for each tolerance, density, and e_p+, which counts missing
/// disparities as errors.
std::vector<Column> score_columns(const std::vector<double>& tolerances_px);

/// One row of them; shares in percent as in the paper.
std::vector<Cell> score_cells(const DisparityScore& score);

/// What score_columns' headings mean, for below a table.
std::string score_legend();

/// Mean of every figure over the frames that have it; pixels are summed.
DisparityScore mean_score(const std::vector<DisparityScore>& scores);

}  // namespace roadstereo::cli
