#include "stereo/coarse/coarse_map.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo {
namespace {

float median_of_three(float a, float b, float c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

float median_of_five(float a, float b, float c, float d, float e) {
  const float lower = std::max(std::min(a, b), std::min(c, d));
  const float upper = std::min(std::max(a, b), std::max(c, d));
  return median_of_three(lower, upper, e);
}

}  // namespace

void median_of_rows(const Image<float>& map, int first, int last, Image<float>& smoothed) {
  const auto row = [&](int v) { return map.row(std::clamp(v, 0, map.height() - 1)); };
  for (int v = first; v < last; ++v) {
    const float *a = row(v - 2), *b = row(v - 1), *own = row(v), *c = row(v + 1), *d = row(v + 2);
    float* out = smoothed.row(v);
    for (int u = 0; u < map.width(); ++u) {
      const bool known = !std::isnan(a[u] + b[u] + own[u] + c[u] + d[u]);
      out[u] = known ? median_of_five(a[u], b[u], c[u], d[u], own[u]) : own[u];
    }
  }
}

void fill_hidden(float* disparity, int columns, std::vector<float>& nearest) {
  constexpr float more = 1;
  const auto target = [&](int u) {
    return static_cast<std::size_t>(std::max(0, u - static_cast<int>(std::lround(disparity[u]))));
  };
  const auto hidden = [&](int u) { return !std::isnan(disparity[u]) && nearest[target(u)] > disparity[u] + more; };
  nearest.assign(static_cast<std::size_t>(columns), 0);
  for (int u = 0; u < columns; ++u) {
    if (!std::isnan(disparity[u])) nearest[target(u)] = std::max(nearest[target(u)], disparity[u]);
  }
  for (int u = 0; u < columns; ++u) {
    if (!hidden(u)) continue;
    int end = u;
    while (end < columns && hidden(end)) ++end;
    const float before = u > 0 ? disparity[u - 1] : disparity[std::min(end, columns - 1)];
    const float after = end < columns ? disparity[end] : before;
    std::fill(disparity + u, disparity + end, std::fmin(before, after));  // the one that is known, when one is not
    u = end;
  }
}

}  // namespace roadstereo
