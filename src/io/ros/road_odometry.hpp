#pragma once

#include <array>
#include <map>
#include <optional>

#include "io/ros/flight_messages.hpp"
#include "roadstereo/calibration.hpp"
#include "roadstereo/disparity_plane.hpp"
#include "roadstereo/trajectory.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Poses in the frame `odom`: the axes of `road_axes` at the first frame of each piece of the trajectory that has a
/// road, z up.
class RoadOdometry {
 public:
  explicit RoadOdometry(const StereoCalibration& calibration) : calibration_(calibration) {}

  /// Returns the pose of the next frame; nullopt before the first frame of its piece that has a road.
  std::optional<RosPose> add(const FramePose& pose, const std::optional<DisparityPlane>& road);

 private:
  StereoCalibration calibration_;
  std::map<int, std::array<double, 12>> world_to_odom_;  // 3×4, row-major, of each piece
};

}  // namespace roadstereo::io
#pragma GCC visibility pop
