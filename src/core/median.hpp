#pragma once

#include <algorithm>
#include <vector>

namespace roadstereo {

/// Standard deviations of a normal distribution in its median absolute deviation.
inline constexpr double gaussian_mad = 1.4826;

/// The upper median of the values, which are reordered. There must be one.
template <class Value>
Value take_median(std::vector<Value>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace roadstereo
