#pragma once

#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// Converts a coordinate of the downsampled image to full resolution.
ROADSTEREO_HD inline double to_full_resolution(double x, int factor) {
  return (x + 0.5) * factor - 0.5;
}

}  // namespace roadstereo
