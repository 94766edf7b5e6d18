#pragma once

#include <array>
#include <vector>

namespace roadstereo {

/// The smallest rectangle of any orientation around points of a plane.
struct OrientedBox {
  double length = 0;     ///< longer side
  double width = 0;      ///< shorter side
  double angle_rad = 0;  ///< of the longer side against the x axis, −π/2 … π/2
};

/// By rotating callipers over the convex hull. All zero for no points.
OrientedBox oriented_box(std::vector<std::array<double, 2>> points);

}  // namespace roadstereo
