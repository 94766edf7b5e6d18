#include "road/line_sums.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "road/line_sums.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void sum_along_lines(const VDisparity& image, float bottom, const float* steps, int count, int row_step, float* sums) {
  const hn::CappedTag<float, 16> df;
  const hn::RebindToSigned<decltype(df)> di;
  const int last = image.rows - 1;
  const auto rounded = hn::Set(df, bottom + 0.5F);
  const auto disparities = hn::Set(di, image.disparities);
  for (int k = 0; k < count; k += static_cast<int>(hn::Lanes(df))) {
    const auto step = hn::LoadU(df, steps + k);
    auto sum = hn::Zero(df);
    for (int r = last; r >= 0; r -= row_step) {
      const auto d = hn::ConvertTo(di, hn::NegMulAdd(step, hn::Set(df, static_cast<float>(last - r)), rounded));
      const auto inside = hn::And(hn::Gt(d, hn::Zero(di)), hn::Lt(d, disparities));
      const auto value = hn::GatherIndex(df, image.row(r), hn::IfThenElseZero(inside, d));
      sum = hn::Add(sum, hn::IfThenElseZero(hn::RebindMask(df, inside), value));
    }
    hn::StoreU(sum, df, sums + k);
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(sum_along_lines);

void sum_along_lines(const VDisparity& image, float bottom, const float* steps, int count, int row_step, float* sums) {
  HWY_DYNAMIC_DISPATCH(sum_along_lines)(image, bottom, steps, count, row_step, sums);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
