#include "road/off_road/column_sums.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "road/off_road/column_sums.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {

/// The loops over u are vectorised.
void add_row(const MapRow& row, const ColumnSums& sums) {
  const int width = row.width;
  const float *HWY_RESTRICT const sigma = row.sigma, *HWY_RESTRICT const disparity = row.disparity;
  std::int32_t *HWY_RESTRICT const log_sigmas = sums.log_sigmas, *HWY_RESTRICT const sigmas = sums.sigmas;
  std::int32_t* HWY_RESTRICT const known = sums.known;
  float* HWY_RESTRICT const residuals = sums.residuals;
  if (row.mask == nullptr) {
    for (int u = 0; u < width; ++u) log_sigmas[u] += log_sigma(sigma[u]);
    for (int u = 0; u < width; ++u) ++sigmas[u];
  } else {
    for (int u = 0; u < width; ++u) {
      const std::int32_t counts = row.mask[u] == 0 ? 1 : 0;
      log_sigmas[u] += counts * log_sigma(sigma[u]);
      sigmas[u] += counts;
    }
  }
  const RowLine shift = row.shift;
  for (int u = 0; u < width; ++u) {
    const float d = disparity[u], residual = without_shift(d, shift, u);
    residuals[u] += d == d ? residual : 0.0F;
    known[u] += d == d ? 1 : 0;
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(add_row);

void add_row(const MapRow& row, const ColumnSums& sums) {
  HWY_DYNAMIC_DISPATCH(add_row)(row, sums);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
