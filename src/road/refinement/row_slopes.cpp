#include "road/refinement/row_slopes.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "road/refinement/row_slopes.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void sum_columns(const HeightRow& row, int radius, int first, int end, const BoxRow& sums) {
  const float *HWY_RESTRICT value = row.value, *HWY_RESTRICT weight = row.precision;
  float *HWY_RESTRICT heights = sums.heights, *HWY_RESTRICT precision = sums.precision;
  for (int u = first; u < end; ++u) heights[u] = precision[u] = 0;
  for (int du = -radius; du <= radius; ++du) {
    for (int u = first; u < end; ++u) {
      heights[u] += weight[u + du] * value[u + du];
      precision[u] += weight[u + du];
    }
  }
}

void mean_of_rows(const BoxRow& rows, std::ptrdiff_t pitch, int count, int first, int end, const BoxRow& means) {
  float *HWY_RESTRICT heights = means.heights, *HWY_RESTRICT precision = means.precision;
  for (int u = first; u < end; ++u) heights[u] = precision[u] = 0;
  for (int k = 0; k < count; ++k) {
    const float *row_heights = rows.heights + k * pitch, *row_precision = rows.precision + k * pitch;
    for (int u = first; u < end; ++u) {
      heights[u] += row_heights[u];
      precision[u] += row_precision[u];
    }
  }
  for (int u = first; u < end; ++u) heights[u] = box_mean(heights[u], precision[u]).height;
}

using Floats = hn::CappedTag<float, 16>;
using Float = hn::Vec<Floats>;

struct Slopes {
  Float value, significance;
};

/// See `limited_slope`.
HWY_INLINE Slopes limited_slopes(Float height, const BoxRow& before, const BoxRow& after, int from, int to,
                                 const SlopeSettings& settings) {
  const Floats d;
  const Float zero = hn::Zero(d), per_step = hn::Set(d, 1 / static_cast<float>(settings.step));
  const Float rise = hn::Mul(hn::Sub(height, hn::LoadU(d, before.heights + from)), per_step);
  const Float further = hn::Mul(hn::Sub(hn::LoadU(d, after.heights + to), height), per_step);
  const Float one = hn::LoadU(d, before.precision + from), other = hn::LoadU(d, after.precision + to);
  const Float product = hn::Mul(rise, further), both = hn::Mul(one, other);
  const auto known = hn::And(hn::Gt(product, zero), hn::Gt(both, zero));
  const Float value = hn::Div(hn::Add(product, product), hn::Add(rise, further));
  const auto step = static_cast<float>(settings.step);
  const Float scale = hn::Set(d, 4 * step * step / settings.samples);
  const Float significance = hn::Div(hn::Mul(hn::Mul(value, value), hn::Mul(scale, both)), hn::Add(one, other));
  return {hn::IfThenElseZero(known, value), hn::IfThenElseZero(known, significance)};
}

void row_slopes(const float* heights, const NearBoxes& boxes, const SlopeSettings& settings, int width, float* across,
                float* down) {
  const Floats d;
  const int step = settings.step;
  for (int u = 0; u < width; u += static_cast<int>(hn::Lanes(d))) {
    const Float height = hn::LoadU(d, heights + u);
    const Slopes of_row = limited_slopes(height, boxes.here, boxes.here, u - step, u + step, settings);
    const Slopes of_column = limited_slopes(height, boxes.above, boxes.below, u, u, settings);
    // See `slope_share`.
    const Float significance = hn::Add(of_row.significance, of_column.significance);
    const Float share = hn::Div(significance, hn::Add(significance, hn::Set(d, slope_of_noise)));
    hn::StoreU(hn::Mul(share, of_row.value), d, across + u);
    hn::StoreU(hn::Mul(share, of_column.value), d, down + u);
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(sum_columns);
HWY_EXPORT(mean_of_rows);
HWY_EXPORT(row_slopes);

void sum_columns(const HeightRow& row, int radius, int first, int end, const BoxRow& sums) {
  HWY_DYNAMIC_DISPATCH(sum_columns)(row, radius, first, end, sums);
}

void mean_of_rows(const BoxRow& rows, std::ptrdiff_t pitch, int count, int first, int end, const BoxRow& means) {
  HWY_DYNAMIC_DISPATCH(mean_of_rows)(rows, pitch, count, first, end, means);
}

void row_slopes(const float* heights, const NearBoxes& boxes, const SlopeSettings& settings, int width, float* across,
                float* down) {
  HWY_DYNAMIC_DISPATCH(row_slopes)(heights, boxes, settings, width, across, down);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
