#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/order_statistics.hpp"

namespace roadstereo {

/// Selects order statistics of many values: counts them in bins, then puts only those in one bin in order. The result
/// is that of `select_rank`.
class BinnedSelection {
 public:
  /// Takes values from `low` on, without NaN; those above `high` have no bin of their own. The values must outlive
  /// this. Returns how many are up to `high`.
  std::size_t bin(std::span<const float> values, float low, float high) {
    values_ = values;
    bins_.resize(values.size());
    const float* const value = values.data();
    std::int32_t* const bin = bins_.data();
    const float bins_per_unit = bin_count / (high - low);
    const float scale = std::isfinite(bins_per_unit) ? bins_per_unit : 0;
    const std::size_t count = values.size();
    // Rounding keeps the order: a larger value is in no smaller bin.
    for (std::size_t k = 0; k < count; ++k) {
      const float place = std::min((value[k] - low) * scale, float{bin_count});
      bin[k] = static_cast<std::int32_t>(value[k] <= high ? place : float{bin_count + 1});
    }
    counts_.fill(0);
    for (const std::int32_t b : bins_) ++counts_[static_cast<std::size_t>(b)];
    return count - counts_.back();
  }

  /// Returns x(rank) of the values.
  float select(std::size_t rank) {
    std::size_t bin = 0;
    while (rank >= counts_[bin]) rank -= counts_[bin++];
    in_bin_.clear();
    for (std::size_t k = 0; k < bins_.size(); ++k) {
      if (static_cast<std::size_t>(bins_[k]) == bin) in_bin_.push_back(values_[k]);
    }
    return select_rank(in_bin_, static_cast<std::ptrdiff_t>(rank));
  }

 private:
  static constexpr std::int32_t bin_count = 256;

  std::span<const float> values_;
  std::vector<std::int32_t> bins_;
  std::array<std::size_t, bin_count + 2> counts_{};  ///< the last of values above `high`
  std::vector<float> in_bin_;
};

/// Smallest and largest of n ≥ 1 values without NaN.
inline std::pair<float, float> range_of(std::span<const float> values) {
  constexpr std::size_t lanes = 8;  // independent of each other, so that the loop is vectorised
  std::array<float, lanes> low, high;
  low.fill(values[0]);
  high.fill(values[0]);
  const float* const value = values.data();
  std::size_t k = 0;
  for (; k + lanes <= values.size(); k += lanes) {
    for (std::size_t l = 0; l < lanes; ++l) {
      low[l] = std::min(low[l], value[k + l]);
      high[l] = std::max(high[l], value[k + l]);
    }
  }
  for (; k < values.size(); ++k) {
    low[0] = std::min(low[0], value[k]);
    high[0] = std::max(high[0], value[k]);
  }
  return {*std::min_element(low.begin(), low.end()), *std::max_element(high.begin(), high.end())};
}

/// Upper median x(⌊n / 2⌋) of n ≥ 1 values without NaN.
inline float binned_median(std::span<const float> values) {
  const auto [low, high] = range_of(values);
  BinnedSelection selection;
  selection.bin(values, low, high);
  return selection.select(values.size() / 2);
}

}  // namespace roadstereo
