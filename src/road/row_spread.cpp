#include "road/row_spread.hpp"

#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "road/row_spread.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using Double = hn::Vec<Doubles>;

/// Sums of a vector of residuals, as `Spread`.
struct Spreads {
  Double n, sum, squares;

  HWY_INLINE void add(Double residual, Double limit) {
    const Doubles dd;
    const auto counts = hn::Le(hn::Abs(residual), limit);  // false for NaN
    const Double counted = hn::IfThenElseZero(counts, residual);
    n = hn::Add(n, hn::IfThenElseZero(counts, hn::Set(dd, 1.0)));
    sum = hn::Add(sum, counted);
    squares = hn::MulAdd(counted, counted, squares);
  }
  HWY_INLINE Spread total() const {
    const Doubles dd;
    return {hn::GetLane(hn::SumOfLanes(dd, n)), hn::GetLane(hn::SumOfLanes(dd, sum)),
            hn::GetLane(hn::SumOfLanes(dd, squares))};
  }
};

RowSpread spread_of_row(const float* row, int width, double delta_t, double limit) {
  const Doubles dd;
  const hn::Rebind<float, Doubles> df;
  const int lanes = static_cast<int>(hn::Lanes(dd));
  constexpr double largest = std::numeric_limits<double>::max();
  const Double none = hn::Zero(dd);
  Spreads all{none, none, none}, road{none, none, none};
  int u = 0;
  for (; u + lanes <= width; u += lanes) {
    const Double residual = hn::Sub(hn::PromoteTo(dd, hn::LoadU(df, row + u)), hn::Set(dd, delta_t));
    all.add(residual, hn::Set(dd, largest));
    road.add(residual, hn::Set(dd, limit));
  }
  RowSpread spread{all.total(), road.total()};
  for (; u < width; ++u) {
    const double residual = row[u] - delta_t;
    if (std::abs(residual) <= largest) spread.all.add(residual);
    if (std::abs(residual) <= limit) spread.road.add(residual);
  }
  return spread;
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(spread_of_row);

RowSpread spread_of_row(const float* row, int width, double delta_t, double limit) {
  return HWY_DYNAMIC_DISPATCH(spread_of_row)(row, width, delta_t, limit);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
