#include "road/lucas_kanade/sample_rows.hpp"

#include "road/lucas_kanade/gauss_newton.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "road/lucas_kanade/sample_rows.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, sample_guard>;
using Float = hn::Vec<Floats>;

void prefilter_row(const std::int16_t* row, int width, float* filtered) {
  for (int u = prefilter_radius; u < width - prefilter_radius; ++u) filtered[u] = prefiltered(row, u);
}

/// Column of the target that matches each pixel from u on, see `without_shift`.
HWY_INLINE Float target_columns(const SampleRow& row, int u) {
  const Floats df;
  const Float offset = hn::Set(df, row.road.offset), slope = hn::Set(df, row.road.slope);
  const Float column = hn::Iota(df, static_cast<float>(u)), disparity = hn::LoadU(df, row.disparity + u);
  const Float scale = hn::Set(df, 1 - row.road.slope);
  const Float residual = hn::Div(hn::Sub(disparity, hn::MulAdd(slope, column, offset)), scale);
  const Float there = hn::Sub(column, residual);
  const auto is_shifted = hn::Gt(hn::MulAdd(slope, there, offset), hn::Zero(df));
  return hn::IfThenElse(is_shifted, there, hn::Sub(column, disparity));
}

HWY_INLINE void add_to(float* sum, Float one, Float other) {
  const Floats df;
  hn::StoreU(hn::MulAdd(one, other, hn::LoadU(df, sum)), df, sum);
}

/// See `alignment_sample` and `AlignmentSums::add`.
void add_samples(const SampleRow& row, std::ptrdiff_t pitch, float* sums) {
  constexpr int margin = prefilter_radius + 1;
  const Floats df;
  const hn::RebindToSigned<Floats> di;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float half = hn::Set(df, 0.5F), one = hn::Set(df, 1.0F), first = hn::Set(df, static_cast<float>(margin));
  const Float min_x = hn::Set(df, static_cast<float>(row.first + margin));
  const Float max_x = hn::Set(df, static_cast<float>(row.width - margin - 1));
  const Float end = hn::Set(df, static_cast<float>(row.width - margin));
  for (int u = 0; u < row.width; u += lanes) {
    const Float column = hn::Iota(df, static_cast<float>(u)), x = target_columns(row, u);
    const auto inside =
        hn::And(hn::And(hn::Ge(x, min_x), hn::Lt(x, max_x)), hn::And(hn::Ge(column, first), hn::Lt(column, end)));
    if (hn::AllFalse(df, inside)) continue;
    const auto at = hn::ConvertTo(di, hn::IfThenElse(inside, x, min_x));
    const Float f = hn::Sub(x, hn::ConvertTo(df, at));
    const Float t0 = hn::GatherIndex(df, row.target - 1, at), t1 = hn::GatherIndex(df, row.target, at);
    const Float t2 = hn::GatherIndex(df, row.target + 1, at), t3 = hn::GatherIndex(df, row.target + 2, at);
    const Float near = hn::Sub(t2, t0), far = hn::Sub(t3, t1);
    const Float square =
        hn::Sub(hn::MulAdd(hn::Set(df, 2.0F), t2, hn::NegMulAdd(hn::Set(df, 2.5F), t1, t0)), hn::Mul(half, t3));
    const Float cube = hn::MulAdd(half, hn::Sub(t3, t0), hn::Mul(hn::Set(df, 1.5F), hn::Sub(t1, t2)));
    const Float value = hn::MulAdd(f, hn::MulAdd(f, hn::MulAdd(f, cube, square), hn::Mul(half, near)), t1);
    const Float across = hn::Sub(hn::LoadU(df, row.reference + u + 1), hn::LoadU(df, row.reference + u - 1));
    const Float target_gradient = hn::Mul(half, hn::MulAdd(f, hn::Sub(far, near), near));
    const auto keep = [&](Float number) { return hn::IfThenElseZero(inside, number); };
    const Float n = keep(one), t = keep(hn::Sub(value, hn::Set(df, alignment_centre)));
    const Float g = keep(hn::Mul(half, hn::MulAdd(half, across, target_gradient)));
    const Float r = keep(hn::Sub(hn::LoadU(df, row.reference + u), value));
    float* sum = sums + u;
    for (const Float number : {n, t, g, r}) {
      add_to(sum, number, one);
      sum += pitch;
    }
    for (const Float other : {t, g, r}) {
      add_to(sum, t, other);
      sum += pitch;
    }
    add_to(sum, g, g);
    add_to(sum + pitch, g, r);
    add_to(sum + 2 * pitch, r, r);
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(prefilter_row);
HWY_EXPORT(add_samples);

void prefilter_row(const std::int16_t* row, int width, float* filtered) {
  HWY_DYNAMIC_DISPATCH(prefilter_row)(row, width, filtered);
}

void add_samples(const SampleRow& row, std::ptrdiff_t pitch, float* sums) {
  HWY_DYNAMIC_DISPATCH(add_samples)(row, pitch, sums);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
