#pragma once

#include "road/refinement/mean_settings.hpp"
#include "road/refinement/slope.hpp"

namespace roadstereo {

/// One pass over a map.
struct RefinementPass {
  int radius = 0;  ///< distance of the window's outermost neighbours from its centre, pixels: a multiple of `step`
  int step = 1;    ///< pixels
  MeanSettings mean;
  SlopeSettings slope;
  bool on_slope = false;  ///< neighbours are expected on the slope of the surface
  bool is_last = true;    ///< writes standard errors and leaves out what is no measurement; else variances
};

}  // namespace roadstereo
