#pragma once

#include <cmath>

#include "stereo/coarse/map_pixel.hpp"

// Where the coarse map changes, it knows the place of the change to the radius of its blocks only: a block that holds
// more contrast on one side of a border takes the disparity of that side, so that dark potholes shrink. There the prior
// is an interval: the disparities of both sides cost nothing. C++17, for kernels.

namespace roadstereo {

/// Disparities from low to high, full-size pixels; NaN: unknown.
struct PriorInterval {
  float low, high;
};

/// Smallest and largest disparity around a pixel; NaN is passed over.
struct DisparitySpread {
  float smallest = INFINITY, largest = -INFINITY;

  ROADSTEREO_HD void add(float disparity) {
    smallest = smaller(smallest, disparity);
    largest = larger(largest, disparity);
  }
};

/// Interval of a pixel of disparity `own`, where one pixel means `pixel_height` in units of border_height_m: all of the
/// spread up to half that height, nothing from it on, since what is higher occludes what is behind it.
ROADSTEREO_HD inline PriorInterval prior_interval(float own, const DisparitySpread& around, float pixel_height) {
  const float left = 2.0F - 2.0F * (around.largest - around.smallest) * pixel_height;
  const float share = left < 0.0F ? 0.0F : left > 1.0F ? 1.0F : left;
  return {own - share * (own - around.smallest), own + share * (around.largest - own)};
}

}  // namespace roadstereo
