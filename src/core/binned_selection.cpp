#include "core/binned_selection.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/order_statistics.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/binned_selection.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Bins of the values: `count` from `low` to `high`, one for `high` and one beyond. Rounding keeps the order: a larger
/// value is in no smaller bin. The loop is vectorised.
void find_bins(std::span<const float> values, float low, float high, std::size_t count, std::uint16_t* bins) {
  const float* const value = values.data();
  const std::size_t size = values.size();
  const auto last = static_cast<float>(count);
  const float bins_per_unit = last / (high - low);
  const float scale = std::isfinite(bins_per_unit) ? bins_per_unit : 0;
  for (std::size_t k = 0; k < size; ++k) {
    const float place = std::min((value[k] - low) * scale, last);
    bins[k] = static_cast<std::uint16_t>(static_cast<std::int32_t>(value[k] <= high ? place : last + 1));
  }
}

/// Write the values of one bin, most often few of them.
void collect(std::span<const float> values, const std::uint16_t* bins, std::uint16_t bin, float* in_bin) {
  const hn::ScalableTag<std::uint16_t> d;
  const std::size_t lanes = hn::Lanes(d), size = values.size();
  const auto wanted = hn::Set(d, bin);
  std::size_t first = 0;
  for (; first + lanes <= size; first += lanes) {
    std::array<std::uint8_t, hn::MaxLanes(d) / 8 + 8> found;  // a bit of each value
    hn::StoreMaskBits(d, hn::Eq(hn::LoadU(d, bins + first), wanted), found.data());
    for (std::size_t k = 0; 8 * k < lanes; ++k) {
      for (unsigned left = found[k]; left != 0; left &= left - 1) {
        *in_bin++ = values[first + 8 * k + static_cast<std::size_t>(std::countr_zero(left))];
      }
    }
  }
  for (; first < size; ++first) {
    if (bins[first] == bin) *in_bin++ = values[first];
  }
}

std::pair<float, float> range_of(std::span<const float> values) {
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

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(find_bins);
HWY_EXPORT(collect);
HWY_EXPORT(range_of);

std::size_t BinnedSelection::bin(std::span<const float> values, float low, float high) {
  values_ = values;
  bins_.resize(values.size());
  HWY_DYNAMIC_DISPATCH(find_bins)(values, low, high, bin_count, bins_.data());
  counts_.fill(0);
  for (const std::uint16_t bin : bins_) ++counts_[bin];
  return values.size() - counts_.back();
}

float BinnedSelection::select(std::size_t rank) {
  std::uint16_t bin = 0;
  while (rank >= counts_[bin]) rank -= counts_[bin++];
  in_bin_.resize(counts_[bin]);
  HWY_DYNAMIC_DISPATCH(collect)(values_, bins_.data(), bin, in_bin_.data());
  return select_rank(in_bin_, static_cast<std::ptrdiff_t>(rank));
}

std::pair<float, float> range_of(std::span<const float> values) {
  return HWY_DYNAMIC_DISPATCH(range_of)(values);
}

float binned_median(std::span<const float> values, float low, float high) {
  BinnedSelection selection;
  selection.bin(values, low, high);
  return selection.select(values.size() / 2);
}

float binned_median(std::span<const float> values) {
  const auto [low, high] = range_of(values);
  return binned_median(values, low, high);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
