// Vector types of the kernels of stereo/cpu.

#include <hwy/highway.h>

#include <cstdint>
#include <limits>

#if defined(ROADSTEREO_STEREO_CPU_VECTOR_INL) == defined(HWY_TARGET_TOGGLE)  // once for every instruction set
#ifdef ROADSTEREO_STEREO_CPU_VECTOR_INL
#undef ROADSTEREO_STEREO_CPU_VECTOR_INL
#else
#define ROADSTEREO_STEREO_CPU_VECTOR_INL
#endif

HWY_BEFORE_NAMESPACE();
namespace roadstereo::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::ScalableTag<std::int32_t>;
using Float = hn::Vec<Floats>;
using Int = hn::Vec<Ints>;

/// first, first + 1, … (hn::Iota of a variable goes through memory.)
template <class D>
HWY_INLINE hn::Vec<D> count_up(D d, int first) {
  return hn::Add(hn::Iota(d, 0), hn::Set(d, first));
}
HWY_INLINE Int count_from(int first) {
  return count_up(Ints(), first);
}

constexpr float infinity = std::numeric_limits<float>::infinity();

}  // namespace roadstereo::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
