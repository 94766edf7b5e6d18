#pragma once

#include <vector>

#include "evaluate/table.hpp"
#include "evaluation/disparity_score.hpp"

namespace roadstereo::cli {

/// The columns, then those of a score: e_r, bias, standard deviation, median, e_p for each tolerance, density, and
/// e_p+, which counts missing disparities as errors.
std::vector<Column> score_columns(std::vector<Column> columns, const std::vector<double>& tolerances_px);

/// The cells, then those of a score; shares in percent as in the paper.
std::vector<Cell> score_cells(std::vector<Cell> cells, const DisparityScore& score);

/// Explanation of the columns, printed below a table.
std::string score_legend();

/// Mean of every value over the scores where it is finite, the density included. A score without a labelled
/// pixel does not count.
DisparityScore mean_score(const std::vector<DisparityScore>& scores);

}  // namespace roadstereo::cli
