#pragma once

#include <vector>

#include "evaluate/table.hpp"
#include "evaluation/disparity_score.hpp"

namespace roadstereo::cli {

/// Tolerance as text for headings and keys: "0.5", "3".
std::string tolerance_text(double tolerance_px);

/// Columns of score_cells: e_r, bias, median, e_p for each tolerance, density, and e_p+, which counts missing
/// disparities as errors.
std::vector<Column> score_columns(const std::vector<double>& tolerances_px);

/// Cells of one score; shares in percent as in the paper.
std::vector<Cell> score_cells(const DisparityScore& score);

/// Explanation of the columns, printed below a table.
std::string score_legend();

/// Mean of every value over the scores where it is finite, the density included. Pixel counts are summed.
DisparityScore mean_score(const std::vector<DisparityScore>& scores);

}  // namespace roadstereo::cli
