#pragma once

#include <array>
#include <vector>

namespace roadstereo {

/// Minimum-area rectangle around points of a plane.
struct OrientedBox {
  double length = 0;     ///< longer side
  double width = 0;      ///< shorter side
  double angle_rad = 0;  ///< from the x axis to the longer side, −π/2 … π/2
};

/// Find the minimum-area rectangle by rotating callipers over the convex hull. All 0 without points.
OrientedBox oriented_box(std::vector<std::array<double, 2>> points);

}  // namespace roadstereo
