#include "stereo/coarse/prior_intervals.hpp"

#include <algorithm>
#include <limits>

#include "stereo/coarse/coarse_road.hpp"
#include "stereo/coarse/prior_interval.hpp"

namespace roadstereo {

void find_prior_intervals(const PerspectiveShift& shift, const PixelHeight& heights, int radius, int first, int last,
                          IntervalScratch& scratch, DisparityPrior& prior) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const Image<float>& map = prior.disparity;
  const auto padded = static_cast<std::size_t>(map.width()) + 2 * static_cast<std::size_t>(radius);
  for (int v = first; v < last; ++v) {
    scratch.smallest.assign(padded, infinity);
    scratch.largest.assign(padded, -infinity);
    float *const smallest = scratch.smallest.data(), *const largest = scratch.largest.data();
    for (int row = std::max(0, v - radius); row <= std::min(map.height() - 1, v + radius); ++row) {
      const float* const at = map.row(row);
      for (int u = 0; u < map.width(); ++u) {
        smallest[u + radius] = smaller(smallest[u + radius], at[u]);
        largest[u + radius] = larger(largest[u + radius], at[u]);
      }
    }
    float *const low = prior.low.row(v), *const high = prior.high.row(v);
    std::fill_n(low, map.width(), infinity);
    std::fill_n(high, map.width(), -infinity);
    for (int k = 0; k <= 2 * radius; ++k) {
      for (int u = 0; u < map.width(); ++u) {
        low[u] = smaller(low[u], smallest[u + k]);
        high[u] = larger(high[u], largest[u + k]);
      }
    }
    const CoarseRoad road(shift, v, prior.factor);
    const float* const own = map.row(v);
    for (int u = 0; u < map.width(); ++u) {
      const PriorInterval interval =
          prior_interval(own[u], {low[u], high[u]}, heights.at(road.disparity(u)), prior.factor);
      low[u] = interval.low;
      high[u] = interval.high;
    }
  }
}

}  // namespace roadstereo
