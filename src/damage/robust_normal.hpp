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

}  // namespace roadstereo
