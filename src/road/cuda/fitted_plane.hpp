#pragma once

#include "road/row_shift.hpp"

namespace roadstereo::cuda {

/// A plane in device memory, which an earlier kernel leaves there, or one that the host knows.
struct PlaneSource {
  const DisparityPlane* in_memory;  ///< null: `value` counts
  DisparityPlane value;

  ROADSTEREO_HD DisparityPlane get() const { return in_memory != nullptr ? *in_memory : value; }
};

/// What a robust fit leaves. The plane comes first, so that its address serves as a PlaneSource.
struct FittedPlane {
  DisparityPlane plane;  ///< the start, when not found
  double scale_px;       ///< robust standard deviation of the inliers
  int iterations;
  int found;       ///< 0: too few points stayed, or all on one line of the image
  int points;      ///< that there were
  int unused = 0;  ///< no byte of what is copied as a whole is left unwritten
};
static_assert(sizeof(FittedPlane) == 4 * sizeof(double) + 4 * sizeof(int));

}  // namespace roadstereo::cuda
