#include "road/refinement/weighted_mean.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "road/refinement/weighted_mean.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void weighted_mean(const MeasuredRow& centre, std::span<const WindowLine> window, const MeanSettings& settings,
                   int width, float* mean, float* precision) {
  const hn::CappedTag<float, 16> d;
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const auto reach2 = hn::Set(d, settings.reach2);
  for (int u = 0; u < width; u += static_cast<int>(hn::Lanes(d))) {
    const auto value = hn::LoadU(d, centre.value + u);
    const auto variance = hn::LoadU(d, centre.variance + u);
    auto weights = zero, away = zero;
    for (const WindowLine& line : window) {
      for (int k = line.first; k <= -line.first; k += line.step) {
        const auto difference = hn::Sub(hn::LoadU(d, line.row.value + u + k), value);
        const auto joint = hn::Mul(reach2, hn::Add(hn::LoadU(d, line.row.variance + u + k), variance));
        const auto agreement = hn::Max(zero, hn::Sub(one, hn::Div(hn::Mul(difference, difference), joint)));
        const auto weight = hn::Mul(hn::Mul(agreement, agreement), hn::LoadU(d, line.row.precision + u + k));
        weights = hn::Add(weights, weight);
        away = hn::MulAdd(weight, difference, away);
      }
    }
    const auto some = hn::Gt(weights, zero);
    hn::StoreU(hn::Add(value, hn::IfThenElseZero(some, hn::Div(away, weights))), d, mean + u);
    hn::StoreU(hn::Max(hn::LoadU(d, centre.precision + u), hn::Mul(weights, hn::Set(d, settings.share))), d,
               precision + u);
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(weighted_mean);

void weighted_mean(const MeasuredRow& centre, std::span<const WindowLine> window, const MeanSettings& settings,
                   int width, float* mean, float* precision) {
  HWY_DYNAMIC_DISPATCH(weighted_mean)(centre, window, settings, width, mean, precision);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
