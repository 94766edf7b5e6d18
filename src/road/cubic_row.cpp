#include "road/cubic_row.hpp"

#include "road/cubic.hpp"
#include "roadstereo/grey_scale.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "road/cubic_row.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {

/// The loop is vectorised.
void sample_cubic(const float* row, float f_at_first, float f_step, int first, int end, std::int16_t* out) {
  for (int x = first; x < end; ++x) {
    const float* p = row + x;
    const float f = f_at_first + static_cast<float>(x - first) * f_step;
    out[x] = grey_between(p[-1], p[0], p[1], p[2], f, static_cast<float>(grey_max));
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(sample_cubic);

void sample_cubic(const float* row, float f_at_first, float f_step, int first, int end, std::int16_t* out) {
  HWY_DYNAMIC_DISPATCH(sample_cubic)(row, f_at_first, f_step, first, end, out);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
