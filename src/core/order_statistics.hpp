#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

// Order statistics by selection (quickselect) of n ≥ 1 values; x(0) ≤ … ≤ x(n − 1) are the sorted ones. Every function
// reorders its values. They differ in the rank that they take between two values. C++17, for kernels.

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

/// Upper median of |x|; 0 of no values. Counts the values by exponent and three bits of the mantissa in single
/// precision, which keep their order: only those of one bin, a tenth of the median wide, are left to select from. No
/// value is NaN.
template <class Values>
double upper_median_magnitude(Values&& values) {
  constexpr std::size_t min_counted = 500;  // counting costs more than selecting from fewer
  if (values.empty()) return 0;
  auto rank = static_cast<std::ptrdiff_t>(values.size() / 2);
  auto last = values.end();
  if (values.size() >= min_counted) {
    constexpr int dropped_bits = 20;
    const auto bin_of = [](auto x) {
      const float magnitude = std::abs(static_cast<float>(x));
      std::uint32_t bits = 0;
      std::memcpy(&bits, &magnitude, sizeof bits);
      return bits >> dropped_bits;
    };
    std::array<std::uint32_t, std::size_t{1} << (31 - dropped_bits)> counts{};
    for (const auto x : values) ++counts[bin_of(x)];
    std::uint32_t bin = 0;
    while (rank >= static_cast<std::ptrdiff_t>(counts[bin])) rank -= static_cast<std::ptrdiff_t>(counts[bin++]);
    last = std::partition(values.begin(), values.end(), [&](auto x) { return bin_of(x) == bin; });
  }
  const auto middle = values.begin() + rank;
  std::nth_element(values.begin(), middle, last, [](auto a, auto b) { return std::abs(a) < std::abs(b); });
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

/// Rank of a quantile of n ≥ 1 values rounded to the nearest, round(share · (n − 1)), 0 ≤ share ≤ 1.
inline std::size_t nearest_rank(double share, std::size_t n) {
  return static_cast<std::size_t>(std::lround(share * static_cast<double>(n - 1)));
}

/// Quantile with the rank rounded to the nearest, x(round(share · (n − 1))), 0 ≤ share ≤ 1.
template <class Values>
auto nearest_quantile(Values&& values, double share) {
  return select_rank(values, static_cast<std::ptrdiff_t>(nearest_rank(share, values.size())));
}

/// Smallest value that a share of the values does not exceed, x(max(⌈share · n⌉, 1) − 1), 0 ≤ share ≤ 1.
template <class Values>
auto covering_quantile(Values&& values, double share) {
  const auto count = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size())));
  return select_rank(values, std::max<std::ptrdiff_t>(count, 1) - 1);
}

}  // namespace roadstereo
