#pragma once

#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Returns the finite values of a map, row by row.
std::vector<double> finite_values(ImageView<const float> map);

/// Returns the median: the mean of the two middle values if their number is even; NaN if there are none.
double median(std::vector<double> values);

/// Returns the sorted value nearest to position share · (n − 1), `share` 0 … 1; NaN if there are none.
double quantile(std::vector<double> values, double share);

/// Returns the root mean square; NaN if there are none.
double rms(const std::vector<double>& values);

}  // namespace roadstereo::cli
