#pragma once

#include <array>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/road_model.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Road plane in space, camera frame (x right, y down, z forward): n·p = height.
struct GroundPlane {
  std::array<double, 3> normal{};  ///< unit vector from the camera towards the road
  double height_m = 0;             ///< distance of the left camera from the plane, metres
  double pitch_rad = 0;            ///< angle of the optical axis below the road's horizon: π/2 looks straight down
};

/// Converts a disparity plane to the plane in space. With d + doffs = f·b/Z and p = Z·((u − u_o)/f, (v − v_o)/f, 1):
/// (a2, a1, (a0 + a1·v_o + a2·u_o + doffs)/f)·p = b.
GroundPlane ground_plane(const DisparityPlane& model, const StereoCalibration& calibration);

/// Standard errors of height and pitch.
struct GroundPlaneError {
  double height_m = 0;
  double pitch_rad = 0;
};

/// Estimates the errors of a road plane from the deviation of the road's surface from it: `deviation_px` is the
/// standard deviation of the disparities over an image of width×height pixels. A plane fitted to another part of the
/// road is taken to be shifted by that, and tilted by it over the standard deviation of the rows and of the columns.
GroundPlaneError ground_plane_error(const DisparityPlane& model, const StereoCalibration& calibration, int width,
                                    int height, double deviation_px);

/// Road coordinates, metres: origin at the foot of the left camera, x to the camera's right, y forward (up in the
/// image), z up out of the road. All three are unit vectors of the camera frame.
struct RoadAxes {
  std::array<double, 3> origin_m{};  ///< camera frame
  std::array<double, 3> x{}, y{}, z{};

  /// Returns a point of the camera frame in these axes, metres.
  std::array<double, 3> to_road(const std::array<double, 3>& point_m) const;
};

/// Returns the axes: x is the camera's x axis projected onto the plane, z opposite to its normal, y = z × x.
RoadAxes road_axes(const GroundPlane& plane);

/// Returns the corners (x, y) of the road in view, metres, in the axes of `road_axes`, counterclockwise from the lower
/// left corner of the image. The view reaches from the last row up to the row in which a pixel covers 1 m of road.
/// Empty if no row shows the road.
std::vector<std::array<double, 2>> road_footprint(const DisparityPlane& model, const StereoCalibration& calibration,
                                                  int width, int height);

}  // namespace roadstereo
#pragma GCC visibility pop
