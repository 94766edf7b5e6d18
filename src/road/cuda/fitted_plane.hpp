#pragma once

#include "core/cuda/host_device.hpp"

namespace roadstereo::cuda {

/// RoadModel for kernels: d(u, v) = a0 + a1·v + a2·u, pixels.
struct DevicePlane {
  double a0, a1, a2;

  ROADSTEREO_HD double disparity(double u, double v) const { return a0 + a1 * v + a2 * u; }
};

/// A plane in device memory, which an earlier kernel leaves there, or one that the host knows.
struct PlaneSource {
  const DevicePlane* in_memory;  ///< null: `value` counts
  DevicePlane value;

  ROADSTEREO_HD DevicePlane get() const { return in_memory != nullptr ? *in_memory : value; }
};

/// What a robust fit leaves. The plane comes first, so that its address serves as a PlaneSource.
struct FittedPlane {
  DevicePlane plane;  ///< the start, when not found
  double scale_px;    ///< robust standard deviation of the inliers
  int iterations;
  int found;   ///< 0: too few points stayed, or all on one line of the image
  int points;  ///< that there were
};

}  // namespace roadstereo::cuda
