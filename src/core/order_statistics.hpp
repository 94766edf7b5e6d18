#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

// Order statistics by selection (quickselect) of n ≥ 1 values; x(0) ≤ … ≤ x(n − 1) are the sorted ones. Every function
// reorders its values. They differ in the rank that they take between two values.

namespace roadstereo {

/// Standard deviation of a normal distribution, in median absolute deviations.
inline constexpr double gaussian_mad = 1.4826;

/// x(rank).
template <class Values>
auto select_rank(Values&& values, std::ptrdiff_t rank) {
  const auto at = values.begin() + rank;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Upper median x(⌊n / 2⌋).
template <class Values>
auto upper_median(Values&& values) {
  return select_rank(values, static_cast<std::ptrdiff_t>(values.size() / 2));
}

/// Upper median of |x|; 0 of no values.
template <class Values>
double upper_median_magnitude(Values&& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end(), [](auto a, auto b) { return std::abs(a) < std::abs(b); });
  return std::abs(*middle);
}

/// Median; of an even number of values the mean of the middle two, (x(n/2 − 1) + x(n/2)) / 2.
template <class Values>
double central_median(Values&& values) {
  const double upper = upper_median(values);
  if (values.size() % 2 == 1) return upper;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  return (*std::max_element(values.begin(), middle) + upper) / 2;
}

/// Quantile with the rank rounded down, x(⌊share · (n − 1)⌋), 0 ≤ share ≤ 1.
template <class Values>
auto lower_quantile(Values&& values, double share) {
  return select_rank(values, static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1)));
}

/// Quantile with the rank rounded to the nearest, x(round(share · (n − 1))), 0 ≤ share ≤ 1.
template <class Values>
auto nearest_quantile(Values&& values, double share) {
  return select_rank(values, static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(values.size() - 1))));
}

/// Smallest value that a share of the values does not exceed, x(max(⌈share · n⌉, 1) − 1), 0 ≤ share ≤ 1.
template <class Values>
auto covering_quantile(Values&& values, double share) {
  const auto count = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size())));
  return select_rank(values, std::max<std::ptrdiff_t>(count, 1) - 1);
}

}  // namespace roadstereo
