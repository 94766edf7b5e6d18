#pragma once

#include <cmath>

#include "roadstereo/host_device.hpp"

namespace roadstereo {

ROADSTEREO_HD inline float smaller(float a, float b) {
  return b < a ? b : a;
}

ROADSTEREO_HD inline float larger(float a, float b) {
  return a < b ? b : a;
}

ROADSTEREO_HD inline float median_of_three(float a, float b, float c) {
  return larger(smaller(a, b), smaller(larger(a, b), c));
}

ROADSTEREO_HD inline float median_of_five(float a, float b, float c, float d, float e) {
  const float lower = larger(smaller(a, b), smaller(c, d));
  const float upper = smaller(larger(a, b), larger(c, d));
  return median_of_three(lower, upper, e);
}

/// Median of a pixel `own`, two above and two below; `own` where one of them is NaN.
ROADSTEREO_HD inline float median_of_rows(float a, float b, float own, float c, float d) {
  const float sum = a + b + own + c + d;
  return sum == sum ? median_of_five(a, b, c, d, own) : own;
}

/// Target column that column u with this disparity, at least −½, projects onto.
ROADSTEREO_HD inline int target_column(int u, float disparity) {
  // lround would keep loops from being vectorised.
  const int column = u - static_cast<int>(disparity + 0.5F);  // NOLINT(bugprone-incorrect-roundings)
  return column > 0 ? column : 0;
}

/// Whether the largest disparity on the pixel's target column occludes the pixel.
ROADSTEREO_HD inline bool is_occluded(float disparity, float nearest) {
  constexpr float margin = 1;
  return nearest > disparity + margin;  // false for NaN
}

}  // namespace roadstereo
