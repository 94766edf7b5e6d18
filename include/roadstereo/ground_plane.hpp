#pragma once

#include <array>

#include "roadstereo/calibration.hpp"
#include "roadstereo/road_model.hpp"

namespace roadstereo {

/// The road as a plane in space, camera frame (x right, y down, z forward): n·p = height.
struct GroundPlane {
  std::array<double, 3> normal{};  ///< unit vector from the camera towards the road
  double height_m = 0;             ///< distance of the left camera from the plane, metres
  double pitch_rad = 0;            ///< angle of the optical axis below the road's horizon: π/2 looks straight down
};

/// The plane that a disparity model stands for. With d + doffs = f·b/Z and p = Z·((u − u_o)/f, (v − v_o)/f, 1):
/// (a2, a1, (a0 + a1·v_o + a2·u_o + doffs)/f)·p = b.
GroundPlane ground_plane(const DisparityPlane& model, const StereoCalibration& calibration);

/// Axes on the road, metres: origin at the foot of the left camera, x to the camera's right, y forward (up in the
/// image), z up out of the road. All three are unit vectors of the camera frame.
struct RoadAxes {
  std::array<double, 3> origin_m{};  ///< camera frame
  std::array<double, 3> x{}, y{}, z{};

  /// A point of the camera frame in the road's axes, metres.
  std::array<double, 3> to_road(const std::array<double, 3>& point_m) const;
};

/// x is the camera's x axis laid onto the plane; z is against the plane's normal; y = z × x.
RoadAxes road_axes(const GroundPlane& plane);

}  // namespace roadstereo
