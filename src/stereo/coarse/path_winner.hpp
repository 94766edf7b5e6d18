#pragma once

#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// The winner of `count` disparities with its fraction, eq. subpixel on the total costs before, at and after it.
ROADSTEREO_HD inline float winner_with_fraction(int winner, int count, float before, float at, float after) {
  const auto disparity = static_cast<float>(winner);
  if (winner == 0 || winner + 1 >= count) return disparity;
  const float curvature = 2 * (before + after - 2 * at);
  return curvature > 0 ? disparity + (before - after) / curvature : disparity;
}

}  // namespace roadstereo
