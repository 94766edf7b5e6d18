#pragma once

#include <vector>

#include "evaluate/table.hpp"
#include "roadstereo/disparity_score.hpp"

namespace roadstereo::cli {

/// A tolerance as headings and keys spell it: "0.5", "3".
std::string tolerance_text(double tolerance_px);

/// Headings of score_cells: e_r, bias, median, e_p for each tolerance, density, e_p with missing counted as errors.
std::vector<Column> score_columns(const std::vector<double>& tolerances_px);

/// One row of them; shares in percent as in the paper.
std::vector<Cell> score_cells(const DisparityScore& score);

}  // namespace roadstereo::cli
