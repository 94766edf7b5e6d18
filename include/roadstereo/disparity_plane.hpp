#pragma once

#include "roadstereo/uncontracted.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Plane in disparity space: d(u, v) = a0 + a1·v + a2·u, pixels; exact for a plane in space. With a2 = 0 it is Δu(v) of
/// eq. (4). C++17, for kernels.
struct DisparityPlane {
  double a0 = 0;  ///< pixels
  double a1 = 0;  ///< pixels per row
  double a2 = 0;  ///< pixels per column

  /// Disparity at column u and row v, pixels; the same bits on the host and on a device.
  ROADSTEREO_HD double disparity(double u, double v) const {
    return a0 + uncontracted_product(a1, v) + uncontracted_product(a2, u);
  }
};

}  // namespace roadstereo
#pragma GCC visibility pop
