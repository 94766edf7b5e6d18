#pragma once

#include <cmath>

#include "core/parabola.hpp"

// The winner of the coarse search with its fraction. C++17, for kernels.

namespace roadstereo {

/// The road as prior of a pixel: disparity d costs weight · min(|d − centre|, truncation)² more.
struct RoadCost {
  float centre;  ///< coarse pixels; NaN: no prior
  float weight, truncation;

  ROADSTEREO_HD float at(float d) const {
    const float distance = fabsf(d - centre), away = distance < truncation ? distance : truncation;
    return centre == centre ? weight * away * away : 0.0F;
  }
};

/// Fraction of a winner beside the road: the mean of the vertex of the pixel's own costs before, at and after it and of
/// the road's offset from it, weighted by their inverse variances. A block's is 2c/K, with the cost c and its second
/// difference K, since its errors are correlated (stereo/window.hpp with n = 1); the road's is 1 / (2 · weight). Where
/// the road is no prior, the winner is one with a variance of 1. The total costs of the paths are suitable for large
/// changes only: where the texture is weak, their penalties and the prior at whole disparities lock the fraction to 0,
/// so that damage of less than a coarse pixel would be lost.
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

/// A winner that is not at either end of the disparities: the total costs of the paths before, at and after it, and the
/// pixel's own costs with the road's.
struct PathWinner {
  float disparity;
  float before, at, after;
  float own_before, own_at, own_after;
};

/// Fraction of a winner: within a coarse pixel of the road that of fraction_near_road, elsewhere eq. (13) on the total
/// costs. Without branches, so that loops over pixels are vectorised.
ROADSTEREO_HD inline float fraction_of(const PathWinner& winner, const RoadCost& road) {
  const float offset = road.centre - winner.disparity;
  const float near_road =
      fraction_near_road(winner.own_before - road.at(winner.disparity - 1), winner.own_at - road.at(winner.disparity),
                         winner.own_after - road.at(winner.disparity + 1), offset, road.weight);
  const float second = second_difference(winner.before, winner.at, winner.after);
  const float half_slope = 0.5F * (winner.before - winner.after), vertex = half_slope / (second > 0 ? second : 1.0F);
  return fabsf(offset) <= 1.0F ? near_road : second > 0 ? vertex : 0.0F;
}

}  // namespace roadstereo
