#pragma once

#include <array>

#include "roadstereo/calibration.hpp"
#include "roadstereo/road_model.hpp"

namespace roadstereo {

/// The road as a plane in space, camera frame (x right, y down, z forward): n·p = height.
struct RoadPlane {
  std::array<double, 3> normal{};  ///< unit vector from the camera towards the road
  double height_m = 0;             ///< distance of the left camera from the plane, metres
  double pitch_rad = 0;            ///< angle of the optical axis below the road's horizon: π/2 looks straight down
};

/// The plane that a disparity model stands for. With d + doffs = f·b/Z and p = Z·((u − u_o)/f, (v − v_o)/f, 1):
/// (a2, a1, (a0 + a1·v_o + a2·u_o + doffs)/f)·p = b.
RoadPlane road_plane(const RoadModel& model, const StereoCalibration& calibration);

}  // namespace roadstereo
