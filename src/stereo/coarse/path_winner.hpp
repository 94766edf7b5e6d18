#pragma once

#include <cmath>

#include "core/parabola.hpp"

// The winner of the coarse search with its fraction. C++17, for kernels.

namespace roadstereo {

/// The road as prior of a pixel: disparity d costs weight · min(|d − centre|, truncation)² more.
struct RoadCost {
  float centre;  ///< coarse pixels; NaN: no prior
  float weight, truncation;

  ROADSTEREO_HD float at(int d) const {
    const float distance = fabsf(static_cast<float>(d) - centre), away = distance < truncation ? distance : truncation;
    return centre == centre ? weight * away * away : 0.0F;
  }
};

/// Fraction of a winner beside the road: the mean of the vertex of the pixel's own costs before, at and after it and of
/// the road's offset from it, weighted by their inverse variances. A block's is 2c/K, with the cost c and its second
/// difference K, since its errors are correlated (stereo/window.hpp with n = 1); the road's is 1 / (2 · weight). Where
/// the road is no prior, the winner is one with a variance of 1. The totals of the paths would do for large changes
/// only: their penalties and the prior at whole disparities lock the fraction to 0 where the texture is weak, and there
/// damage below a coarse pixel would be lost.
ROADSTEREO_HD inline float fraction_near_road(float before, float at, float after, float offset, float weight) {
  // All times 2c. The vertex, half of the slope over K, is at most a pixel away.
  constexpr float min_cost = 0.02F;
  const float cost2 = 2 * (at > min_cost ? at : min_cost), second = second_difference(before, at, after);
  const float curvature = second > 0 ? second : 0.0F, half_slope = 0.5F * (before - after);
  const float bounded = half_slope < -curvature ? -curvature : half_slope > curvature ? curvature : half_slope;
  const float road = cost2 * 2 * weight;
  const float mean = (bounded + road * offset) / (curvature + (weight > 0 ? road : cost2));
  return mean < -0.5F ? -0.5F : mean > 0.5F ? 0.5F : mean;
}

/// Returns the winner of `count` disparities with its fraction: within a coarse pixel of the road that of
/// fraction_near_road, elsewhere eq. (13) on the total costs before, at and after it. `costs`: the pixel's own costs
/// with the road's.
ROADSTEREO_HD inline float winner_with_fraction(int winner, int count, float before, float at, float after,
                                                const float* costs, const RoadCost& road) {
  const auto disparity = static_cast<float>(winner);
  if (winner == 0 || winner + 1 >= count) return disparity;
  const float offset = road.centre - disparity;
  if (fabsf(offset) <= 1.0F) {
    const auto own = [&](int d) { return costs[d] - road.at(d); };
    return disparity + fraction_near_road(own(winner - 1), own(winner), own(winner + 1), offset, road.weight);
  }
  return second_difference(before, at, after) > 0 ? disparity + parabola_vertex(before, at, after) : disparity;
}

}  // namespace roadstereo
