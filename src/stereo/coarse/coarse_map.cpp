#include "stereo/coarse/coarse_map.hpp"

#include <algorithm>
#include <cmath>

#include "stereo/coarse/map_pixel.hpp"

namespace roadstereo {
void median_of_rows(const Image<float>& map, int first, int last, Image<float>& smoothed) {
  const auto row = [&](int v) { return map.row(std::clamp(v, 0, map.height() - 1)); };
  for (int v = first; v < last; ++v) {
    const float *a = row(v - 2), *b = row(v - 1), *own = row(v), *c = row(v + 1), *d = row(v + 2);
    float* out = smoothed.row(v);
    for (int u = 0; u < map.width(); ++u) out[u] = median_of_rows(a[u], b[u], own[u], c[u], d[u]);
  }
}

void fill_occlusions(float* disparity, int columns, std::vector<float>& nearest) {
  const auto target = [&](int u) { return static_cast<std::size_t>(target_column(u, disparity[u])); };
  const auto occluded = [&](int u) {
    return !std::isnan(disparity[u]) && is_occluded(disparity[u], nearest[target(u)]);
  };
  nearest.assign(static_cast<std::size_t>(columns), 0);
  for (int u = 0; u < columns; ++u) {
    if (!std::isnan(disparity[u])) nearest[target(u)] = std::max(nearest[target(u)], disparity[u]);
  }
  for (int u = 0; u < columns; ++u) {
    if (!occluded(u)) continue;
    int end = u;
    while (end < columns && occluded(end)) ++end;
    const float before = u > 0 ? disparity[u - 1] : disparity[std::min(end, columns - 1)];
    const float after = end < columns ? disparity[end] : before;
    std::fill(disparity + u, disparity + end, std::fmin(before, after));  // the one that is known, when one is not
    u = end;
  }
}

}  // namespace roadstereo
