#pragma once

#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// Full-size coordinate of a coordinate of the shrunk image.
ROADSTEREO_HD inline double to_full_resolution(double x, int factor) {
  return (x + 0.5) * factor - 0.5;
}

}  // namespace roadstereo
