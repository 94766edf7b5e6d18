#pragma once

#include "roadstereo/perspective_shift.hpp"

namespace roadstereo {

/// Disparity of the road after the shift, full-size pixels; `invalid` above the horizon and without a road.
ROADSTEREO_HD inline double shifted_road(const PerspectiveShift& shift, double u, double v, double invalid) {
  const double disparity = shift.enabled ? shift.road.disparity(u, v) : -1;
  if (disparity < 0) return invalid;
  return disparity < shift.delta_p ? disparity : shift.delta_p;
}

}  // namespace roadstereo
