#pragma once

#include <vector>

#include "odometry/image_pyramid.hpp"
#include "odometry/rigid_motion.hpp"
#include "roadstereo/calibration.hpp"
#include "roadstereo/ground_plane.hpp"

namespace roadstereo {

/// Square grid of a road plane, in the axes of the road (RoadAxes).
struct GroundGrid {
  static constexpr int side = 128;  ///< cells; a power of two
  double cell_m = 0;
  double centre_x_m = 0;
  double centre_y_m = 0;
};

/// Road plane of a frame as alignment needs it.
struct FrameRoad {
  GroundPlane plane;
  RoadAxes axes;
  GroundGrid grid;  ///< covers what the frame sees of the road
};

/// Returns the road of a plane and the grid over that part of it in which a pixel covers at most four times as much as
/// at the bottom of the image. False when the frame sees too little of the road.
bool frame_road(const DisparityPlane& plane, const StereoCalibration& calibration, int width, int height,
                FrameRoad& road);

/// Samples the grey levels of a frame at the cells of a grid that is rotated by `yaw_rad` about its centre; side ×
/// side. Cells are high-pass filtered and tapered to 0 at the border of what the frame sees.
void sample_ground(const ImagePyramid& pyramid, const StereoCalibration& calibration, const FrameRoad& road,
                   const GroundGrid& grid, double yaw_rad, std::vector<float>& cells);

/// Returns the motion between camera frames that moves points of the road by a rotation of `yaw_rad` about the foot of
/// the camera, and then by (x_m, y_m), in the axes of both roads.
RigidMotion planar_motion(const FrameRoad& from, const FrameRoad& to, double yaw_rad, double x_m, double y_m);

}  // namespace roadstereo
