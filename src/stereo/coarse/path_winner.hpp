#pragma once

#include "core/parabola.hpp"

namespace roadstereo {

/// Returns the winner of `count` disparities with its fraction, eq. (13) on the total costs before, at and after it.
ROADSTEREO_HD inline float winner_with_fraction(int winner, int count, float before, float at, float after) {
  const auto disparity = static_cast<float>(winner);
  if (winner == 0 || winner + 1 >= count) return disparity;
  return second_difference(before, at, after) > 0 ? disparity + parabola_vertex(before, at, after) : disparity;
}

}  // namespace roadstereo
