#include "damage/pixel_sums.hpp"

#include <algorithm>
#include <cmath>

#include "core/map_value.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "damage/pixel_sums.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {

// The loops over u are vectorised.

int count_uncertain(const float* sigma, int width) {
  int count = 0;
  for (int u = 0; u < width; ++u) count += sigma[u] > max_sigma_px ? 1 : 0;
  return count;
}

void add_valid(const float* HWY_RESTRICT values, const float* HWY_RESTRICT sigma, int width, float* HWY_RESTRICT sums,
               int* HWY_RESTRICT counts) {
  for (int u = 0; u < width; ++u) {
    const int finite = std::abs(values[u]) <= max_map_value ? 1 : 0;
    const int uncertain = sigma[u] > max_sigma_px ? 1 : 0;
    const int valid = finite & ~uncertain;
    counts[u] += valid;
    sums[u] += valid != 0 ? values[u] : 0.0F;
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(count_uncertain);
HWY_EXPORT(add_valid);

bool has_uncertain(const float* sigma, int width) {
  return HWY_DYNAMIC_DISPATCH(count_uncertain)(sigma, width) > 0;
}

void PixelSums::clear() {
  std::fill(sum.begin(), sum.end(), 0.0F);
  std::fill(count.begin(), count.end(), 0);
}

void PixelSums::add(const float* values, const float* sigma, int width) {
  HWY_DYNAMIC_DISPATCH(add_valid)(values, sigma, width, sum.data(), count.data());
}

}  // namespace roadstereo
#endif  // HWY_ONCE
