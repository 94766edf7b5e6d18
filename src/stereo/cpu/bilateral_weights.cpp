#include "stereo/cpu/bilateral_weights.hpp"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/cpu/bilateral_weights.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::ScalableTag<std::int32_t>;
using Float = hn::Vec<Floats>;
using Int = hn::Vec<Ints>;

/// 2^x for x ≤ 0, relative error below 3e-6; x below −100 gives a vanishing number.
HWY_INLINE Float power_of_two(Float x) {
  const Floats df;
  const Ints di;
  const Float bounded = hn::Max(x, hn::Set(df, -100.0f));
  const Int whole = hn::NearestInt(bounded);
  const Float f = hn::Sub(bounded, hn::ConvertTo(df, whole));
  Float p = hn::Set(df, 9.58285e-3f);
  p = hn::MulAdd(p, f, hn::Set(df, 5.590643e-2f));
  p = hn::MulAdd(p, f, hn::Set(df, 2.4024099e-1f));
  p = hn::MulAdd(p, f, hn::Set(df, 6.9312419e-1f));
  p = hn::MulAdd(p, f, hn::Set(df, 1.0f));
  // Adds `whole` to the exponent.
  return hn::BitCast(df, hn::Add(hn::BitCast(di, p), hn::ShiftLeft<23>(whole)));
}

void bilateral_weights(const float* centre, const float* neighbour, float log2_space, float log2_colour, int first,
                       int end, float* weights) {
  const Floats d;
  const Float space = hn::Set(d, log2_space);
  const Float colour = hn::Set(d, log2_colour);
  for (int i = first; i < end; i += static_cast<int>(hn::Lanes(d))) {
    const Float difference = hn::Sub(hn::LoadU(d, centre + i), hn::LoadU(d, neighbour + i));
    const Float exponent = hn::MulAdd(hn::Mul(difference, difference), colour, space);
    hn::StoreU(power_of_two(exponent), d, weights + i);
  }
}

}  // namespace roadstereo::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo::cpu {

HWY_EXPORT(bilateral_weights);

void bilateral_weights(const float* centre, const float* neighbour, float log2_space, float log2_colour, int first,
                       int end, float* weights) {
  HWY_DYNAMIC_DISPATCH(bilateral_weights)(centre, neighbour, log2_space, log2_colour, first, end, weights);
}

}  // namespace roadstereo::cpu
#endif  // HWY_ONCE
