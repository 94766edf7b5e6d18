#include "stereo/coarse/prior_intervals.hpp"

#include <algorithm>
#include <limits>

#include "stereo/coarse/coarse_road.hpp"
#include "stereo/coarse/prior_interval.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/coarse/prior_intervals.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {

void find_prior_intervals(const PerspectiveShift& shift, const PixelHeight& heights, int radius, int first, int last,
                          IntervalScratch& scratch, DisparityPrior& prior) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const Image<float>& map = prior.disparity;
  const int width = map.width();
  const auto padded = static_cast<std::size_t>(width) + 2 * static_cast<std::size_t>(radius);
  for (int v = first; v < last; ++v) {
    scratch.smallest.assign(padded, infinity);
    scratch.largest.assign(padded, -infinity);
    float *HWY_RESTRICT smallest = scratch.smallest.data(), *HWY_RESTRICT largest = scratch.largest.data();
    for (int row = std::max(0, v - radius); row <= std::min(map.height() - 1, v + radius); ++row) {
      const float* const at = map.row(row);
      for (int u = 0; u < width; ++u) {
        smallest[u + radius] = smaller(smallest[u + radius], at[u]);
        largest[u + radius] = larger(largest[u + radius], at[u]);
      }
    }
    float *HWY_RESTRICT low = prior.low.row(v), *HWY_RESTRICT high = prior.high.row(v);
    std::fill_n(low, width, infinity);
    std::fill_n(high, width, -infinity);
    for (int k = 0; k <= 2 * radius; ++k) {
      for (int u = 0; u < width; ++u) {
        low[u] = smaller(low[u], smallest[u + k]);
        high[u] = larger(high[u], largest[u + k]);
      }
    }
    const CoarseRoad road(shift, v, prior.factor);
    const float* const own = map.row(v);
    const int factor = prior.factor;
    for (int u = 0; u < width; ++u) {
      const PriorInterval interval = prior_interval(own[u], {low[u], high[u]}, heights.at(road.disparity(u)), factor);
      low[u] = interval.low;
      high[u] = interval.high;
    }
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(find_prior_intervals);

void find_prior_intervals(const PerspectiveShift& shift, const PixelHeight& heights, int radius, int first, int last,
                          IntervalScratch& scratch, DisparityPrior& prior) {
  HWY_DYNAMIC_DISPATCH(find_prior_intervals)(shift, heights, radius, first, last, scratch, prior);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
