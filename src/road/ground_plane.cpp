#include "roadstereo/ground_plane.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo {

GroundPlane ground_plane(const DisparityPlane& model, const StereoCalibration& calibration) {
  const double at_centre = model.disparity(calibration.cx_px, calibration.cy_px) + calibration.disparity_offset_px;
  const std::array<double, 3> g{model.a2, model.a1, at_centre / calibration.focal_px};
  const double length = std::hypot(g[0], g[1], g[2]);
  GroundPlane plane;
  plane.normal = {g[0] / length, g[1] / length, g[2] / length};
  plane.height_m = calibration.baseline_m / length;
  plane.pitch_rad = std::asin(std::clamp(plane.normal[2], -1.0, 1.0));
  return plane;
}

std::array<double, 3> RoadAxes::to_road(const std::array<double, 3>& point_m) const {
  const std::array<double, 3> p{point_m[0] - origin_m[0], point_m[1] - origin_m[1], point_m[2] - origin_m[2]};
  const auto dot = [&p](const std::array<double, 3>& axis) { return p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2]; };
  return {dot(x), dot(y), dot(z)};
}

RoadAxes road_axes(const GroundPlane& plane) {
  const std::array<double, 3>& n = plane.normal;
  RoadAxes frame;
  frame.origin_m = {plane.height_m * n[0], plane.height_m * n[1], plane.height_m * n[2]};
  frame.z = {-n[0], -n[1], -n[2]};
  const double length = std::sqrt(1 - n[0] * n[0]);
  frame.x = {length, -n[0] * n[1] / length, -n[0] * n[2] / length};
  const std::array<double, 3>& x = frame.x;
  const std::array<double, 3>& z = frame.z;
  frame.y = {z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]};
  return frame;
}

}  // namespace roadstereo
