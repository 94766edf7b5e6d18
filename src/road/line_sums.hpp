#pragma once

#include <cstddef>

namespace roadstereo {

/// A v-disparity image: evidence of every row of the image for each disparity.
struct VDisparity {
  const float* values;  ///< row by row, `disparities` apart
  int rows, disparities;

  const float* row(int r) const { return values + std::ptrdiff_t{r} * disparities; }
};

/// What every cell of a picture says to each disparity.
struct DisparityCells {
  const float* values;  ///< row by row of cells, `disparities` values a cell
  int rows, columns, disparities;
};

/// Sum of the values at a plane that has the disparity `first` in the first cell, `row_step` more in every further row
/// and `column_step` more in every further column; linear between two disparities, nothing beyond 0 … last.
double sum_along_plane(const DisparityCells& cells, float first, float row_step, float column_step);

/// Elements behind the last line that sum_along_lines reads and writes.
inline constexpr int line_sums_guard = 15;

/// For each of `count` lines that have the disparity `bottom` in the last row and steps[k] less in every row above it,
/// the sum of the values at the nearest disparities, in every `row_step`-th row from the last; nothing beyond the
/// disparities 1 … last. `steps` has numbers in its guard, too.
void sum_along_lines(const VDisparity& image, float bottom, const float* steps, int count, int row_step, float* sums);

}  // namespace roadstereo
