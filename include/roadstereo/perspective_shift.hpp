#pragma once

#include <cmath>

#include "roadstereo/disparity_plane.hpp"

namespace roadstereo {

/// Shift of the perspective transformation: the target pixel at column x of the transformed image comes from column
/// x − at(x, v) of the target image. C++17, for kernels.
struct PerspectiveShift {
  DisparityPlane road;       ///< Δu, eq. (4)
  double delta_p = 0;        ///< δp, pixels: residual disparity of the road
  int disparities = 1;       ///< D: residual disparities 0 … D−1 are searched
  bool whole_pixel = false;  ///< shifts are rounded to whole pixels
  bool enabled = true;       ///< false: every shift is 0
  double row_offset = 0;     ///< the target's rows lie this much lower than the reference's, pixels; also undone

  /// max(0, Δu − δp), pixels.
  ROADSTEREO_HD double at(double x, double v) const {
    if (!enabled) return 0;
    const double beyond = road.disparity(x, v) - delta_p;
    const double bounded = beyond > 0 ? beyond : 0;
    return whole_pixel ? round(bounded) : bounded;
  }
};

}  // namespace roadstereo
