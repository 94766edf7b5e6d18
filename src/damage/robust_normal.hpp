#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/binned_selection.hpp"
#include "core/order_statistics.hpp"

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
  const auto [low, high] = range_of(values);
  const std::size_t middle = values.size() / 2;
  BinnedSelection selection;
  selection.bin(values, low, high);
  const float median = selection.select(middle), farthest = std::max(high - median, median - low);
  for (float& value : values) value = std::abs(value - median);
  selection.bin(values, 0, farthest);
  return {median, gaussian_mad * selection.select(middle), values.size()};
}

}  // namespace roadstereo
