#include "road/refinement/weighted_mean.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "road/refinement/weighted_mean.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void weighted_mean(const MeasuredRow& centre, const SlopeRow& slopes, std::span<const WindowLine> window,
                   const MeanSettings& settings, int width, float* mean, float* precision) {
  const hn::CappedTag<float, 16> d;
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const auto reach2 = hn::Set(d, settings.reach2);
  for (int u = 0; u < width; u += static_cast<int>(hn::Lanes(d))) {
    const auto value = hn::LoadU(d, centre.value + u);
    const auto variance = hn::LoadU(d, centre.variance + u);
    const auto across = hn::LoadU(d, slopes.across + u), down = hn::LoadU(d, slopes.down + u);
    auto weights = zero, away = zero, squares = zero, expected_squares = zero;
    for (const WindowLine& line : window) {
      const auto expected_in_row = hn::MulAdd(down, hn::Set(d, static_cast<float>(line.below)), value);
      for (int k = line.first; k <= -line.first; k += line.step) {
        const auto expected_there = hn::MulAdd(across, hn::Set(d, static_cast<float>(k)), expected_in_row);
        const auto difference = hn::Sub(hn::LoadU(d, line.row.value + u + k), expected_there);
        const auto joint = hn::Mul(reach2, hn::Add(hn::LoadU(d, line.row.variance + u + k), variance));
        const auto agreement = hn::Max(zero, hn::Sub(one, hn::Div(hn::Mul(difference, difference), joint)));
        const auto share = hn::Mul(agreement, agreement);
        const auto other_precision = hn::LoadU(d, line.row.precision + u + k);
        const auto weight = hn::Mul(share, other_precision);
        const auto weighted = hn::Mul(weight, difference);
        weights = hn::Add(weights, weight);
        away = hn::Add(away, weighted);
        squares = hn::MulAdd(weighted, difference, squares);
        expected_squares = hn::Add(expected_squares, hn::IfThenElseZero(hn::Gt(other_precision, zero), share));
      }
    }
    const auto some = hn::Gt(weights, zero);
    const auto shift = hn::IfThenElseZero(some, hn::Div(away, weights));
    hn::StoreU(hn::Add(value, shift), d, mean + u);
    // Scatter of the neighbours beyond their variances, of a surface that is not level there, adds to the variance.
    const auto scatter = hn::IfThenElseZero(some, hn::Div(hn::Sub(squares, expected_squares), weights));
    const auto excess = hn::Max(zero, hn::NegMulAdd(shift, shift, scatter));
    const auto averaged = hn::Max(hn::LoadU(d, centre.precision + u), hn::Mul(weights, hn::Set(d, settings.share)));
    hn::StoreU(hn::Div(averaged, hn::MulAdd(averaged, excess, one)), d, precision + u);
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(weighted_mean);

void weighted_mean(const MeasuredRow& centre, const SlopeRow& slopes, std::span<const WindowLine> window,
                   const MeanSettings& settings, int width, float* mean, float* precision) {
  HWY_DYNAMIC_DISPATCH(weighted_mean)(centre, slopes, window, settings, width, mean, precision);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
