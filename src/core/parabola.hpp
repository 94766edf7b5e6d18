#pragma once

#include "roadstereo/host_device.hpp"

// Parabola through three equidistant values, eq. (13). C++17, for kernels.

namespace roadstereo {

/// Curvature of the parabola: positive at a minimum, negative at a maximum.
template <class Real>
ROADSTEREO_HD Real second_difference(Real before, Real at, Real after) {
  return before + after - 2 * at;
}

/// Position of the vertex, in steps from the middle value; the curvature must not be 0.
template <class Real>
ROADSTEREO_HD Real parabola_vertex(Real before, Real at, Real after) {
  return (before - after) / (2 * second_difference(before, at, after));
}

}  // namespace roadstereo
