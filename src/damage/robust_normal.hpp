#pragma once

#include <cmath>
#include <vector>

#include "core/binned_selection.hpp"

namespace roadstereo {

/// Normal distribution by median and median absolute deviation.
struct RobustNormal {
  double median = 0;
  double sigma = 0;
  std::size_t samples = 0;
};

/// Estimate the distribution of a sample; `values` are overwritten. An empty sample gives zeros.
inline RobustNormal robust_normal(std::vector<float>& values) {
  if (values.empty()) return {};
  const float median = binned_median(values);
  for (float& value : values) value = std::abs(value - median);
  return {median, gaussian_mad * binned_median(values), values.size()};
}

/// Value at equal distance from both medians in standard deviations; the middle where both sigmas are 0.
inline double threshold_between(const RobustNormal& one, const RobustNormal& other) {
  const double sum = one.sigma + other.sigma;
  if (!(sum > 0)) return 0.5 * (one.median + other.median);
  return (one.median * other.sigma + other.median * one.sigma) / sum;
}

}  // namespace roadstereo
