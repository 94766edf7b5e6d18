#pragma once

#include <cmath>

#include "core/full_resolution.hpp"
#include "road/row_shift.hpp"

namespace roadstereo {

/// Cost of a disparity without a counterpart: that of uncorrelated blocks.
constexpr float no_evidence = 1;
/// Ignorance below which the road hardly pulls.
constexpr float knows_enough = 0.1F;

/// Disparities within two coarse pixels of the road's, of `count`: first ≤ d < end.
struct NearRoad {
  int first, end;
};

ROADSTEREO_HD inline NearRoad near_road(float road, int count) {
  constexpr int near = 2;
  const int centre = static_cast<int>(lroundf(road));
  const int first = centre - near < 0 ? 0 : centre - near > count ? count : centre - near;
  const int wanted = centre + near + 1;
  return {first, wanted < first ? first : wanted > count ? count : wanted};
}

/// How far the costs of a pixel leave the road possible: 1 where they are as low near it as anywhere, 0 where they are
/// so much lower elsewhere that the pixel shows something else.
ROADSTEREO_HD inline float cost_plausibility(float at_road, float least) {
  constexpr float doubtful = 0.2F, impossible = 0.4F;  // in units of the correlation
  const float chance = (impossible - (at_road - least)) / (impossible - doubtful);
  return chance < 0.0F ? 0.0F : chance > 1.0F ? 1.0F : chance;
}

/// Coarse disparity that the road has after the shift at a pixel of the shrunk pair; `nothing` beyond the horizon and
/// The disparity that the road has after the shift, full-size pixels; `nothing` where there is none: above the horizon,
/// or without a road.
ROADSTEREO_HD inline double shifted_road(const PerspectiveShift& shift, double u, double v, double nothing) {
  const double disparity = shift.enabled ? shift.road.disparity(u, v) : -1;
  if (disparity < 0) return nothing;
  return disparity < shift.delta_p ? disparity : shift.delta_p;
}

/// without a shift.
ROADSTEREO_HD inline float coarse_road(const PerspectiveShift& shift, int u, int v, int factor, float nothing) {
  const double road =
      shifted_road(shift, to_full_resolution(u, factor), to_full_resolution(v, factor), static_cast<double>(nothing));
  return static_cast<float>(road) / static_cast<float>(factor);
}

}  // namespace roadstereo
