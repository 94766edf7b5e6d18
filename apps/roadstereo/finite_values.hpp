#pragma once

#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// The values of a map that are neither NaN nor infinite, row by row.
std::vector<double> finite_values(ImageView<const float> map);

/// Mean of the two middle values when their number is even; NaN when there is none.
double median(std::vector<double> values);

/// Value that `share` (0 … 1) of the values do not exceed: the nearest rank. NaN when there is none.
double quantile(std::vector<double> values, double share);

}  // namespace roadstereo::cli
