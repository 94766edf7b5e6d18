#pragma once

#include <array>
#include <memory>
#include <vector>

namespace roadstereo::cli {

/// Way of the camera since the last frame that could not be linked, seen from above. Axes of the road under its first
/// camera: x to the right, y ahead.
struct LivePath {
  std::vector<std::array<double, 2>> points_m;  ///< thinned; the last is that of the newest frame
  double heading_rad = 0;                       ///< of the view, clockwise from y
  double length_m = 0;
  int pieces = 1;          ///< so far: 1 more with every frame that could not be linked
  double odometry_ms = 0;  ///< mean of a frame
  double share = 0;        ///< of the time since the first frame until the next may begin that odometry took, 0 … 1
};

using SharedPath = std::shared_ptr<const LivePath>;

}  // namespace roadstereo::cli
