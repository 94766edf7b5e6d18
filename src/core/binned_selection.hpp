#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace roadstereo {

/// Selects order statistics of many values: counts them in bins, then puts only those in one bin in order. The result
/// is that of `select_rank`.
class BinnedSelection {
 public:
  /// Takes values from `low` on, without NaN; those above `high` have no bin of their own. The values must outlive
  /// this. Returns how many are up to `high`.
  std::size_t bin(std::span<const float> values, float low, float high);

  /// Returns x(rank) of the values.
  float select(std::size_t rank);

 private:
  static constexpr std::size_t bin_count = 256;

  std::span<const float> values_;
  std::vector<std::uint16_t> bins_;
  std::array<std::uint32_t, bin_count + 2> counts_{};  ///< the last of values above `high`
  std::vector<float> in_bin_;
};

/// Smallest and largest of n ≥ 1 values without NaN.
std::pair<float, float> range_of(std::span<const float> values);

/// Upper median x(⌊n / 2⌋) of n ≥ 1 values without NaN, all from `low` to `high`.
float binned_median(std::span<const float> values, float low, float high);

/// The same for values of any range.
float binned_median(std::span<const float> values);

}  // namespace roadstereo
