#pragma once

#include <cmath>

#include "stereo/coarse/map_pixel.hpp"

// Where the coarse map changes, the place of the change is known only to within the radius of its blocks: a block with
// more contrast on one side of a border takes the disparity of that side, so that dark potholes would shrink. There the
// prior is an interval: the disparities of both sides cost nothing. C++17, for kernels.

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

/// Rises from 0 at one half to 1 at one.
ROADSTEREO_HD inline float from_half_to_one(float x) {
  return x < 0.5F ? 0.0F : x > 1.0F ? 1.0F : 2.0F * x - 1.0F;
}

/// Interval of a pixel of disparity `own`, where one pixel means `pixel_height` in units of border_height_m: the full
/// spread up to half of that height, none of it from that height on, since higher objects occlude what is behind them;
/// none of it up to half a coarse pixel (`factor` pixels), which is noise of the map, and the full spread from one
/// coarse pixel on.
ROADSTEREO_HD inline PriorInterval prior_interval(float own, const DisparitySpread& around, float pixel_height,
                                                  int factor) {
  const float spread = around.largest - around.smallest;
  const float share =
      from_half_to_one(spread / static_cast<float>(factor)) * (1.0F - from_half_to_one(spread * pixel_height));
  return {own - share * (own - around.smallest), own + share * (around.largest - own)};
}

}  // namespace roadstereo
