#pragma once

#include <cstddef>

// Sums of the windows around the cells of a row, in double precision, with vector instructions.

namespace roadstereo {

/// sums[i] = Σ numbers[i + y·pitch] over `rows` rows, for i in [0, count).
void sum_rows(const float* numbers, std::ptrdiff_t pitch, int rows, int count, double* sums);

/// sums[i] = Σ numbers[i − radius … i + radius], without those beyond the ends of the row.
void sum_columns(const double* numbers, int columns, int radius, double* sums);

}  // namespace roadstereo
