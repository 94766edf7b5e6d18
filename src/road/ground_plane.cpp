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

GroundPlaneError ground_plane_error(const DisparityPlane& model, const StereoCalibration& calibration, int width,
                                    int height, double deviation_px) {
  const double row_sigma = height / std::sqrt(12.0), column_sigma = width / std::sqrt(12.0);
  const double by_row = deviation_px / row_sigma, by_column = deviation_px / column_sigma;
  const GroundPlane plane = ground_plane(model, calibration);
  const double middle_v = 0.5 * (height - 1), middle_u = 0.5 * (width - 1);
  GroundPlaneError error;
  for (const DisparityPlane& change :
       {DisparityPlane{deviation_px, 0, 0}, DisparityPlane{-by_row * middle_v, by_row, 0},
        DisparityPlane{-by_column * middle_u, 0, by_column}}) {
    const GroundPlane other =
        ground_plane({model.a0 + change.a0, model.a1 + change.a1, model.a2 + change.a2}, calibration);
    error.height_m = std::hypot(error.height_m, other.height_m - plane.height_m);
    error.pitch_rad = std::hypot(error.pitch_rad, other.pitch_rad - plane.pitch_rad);
  }
  return error;
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

std::vector<std::array<double, 2>> road_footprint(const DisparityPlane& model, const StereoCalibration& calibration,
                                                  int width, int height) {
  constexpr double max_gsd_m = 1;  // along the road: Z² / (h·f)
  const GroundPlane plane = ground_plane(model, calibration);
  const RoadAxes axes = road_axes(plane);
  const double max_z = std::sqrt(max_gsd_m * plane.height_m * calibration.focal_px);
  const double min_disparity = calibration.focal_px * calibration.baseline_m / max_z - calibration.disparity_offset_px;
  const int last = height - 1;
  const auto first_row = [&](int u) {
    int v = 0;
    while (v <= last && model.disparity(u, v) < min_disparity) ++v;
    return v;
  };
  const int left = first_row(0), right = first_row(width - 1);
  if (left >= last || right >= last) return {};
  std::vector<std::array<double, 2>> corners;
  for (const auto& [u, v] : {std::array{0, last}, {width - 1, last}, {width - 1, right}, {0, left}}) {
    const auto on_road = axes.to_road(calibration.point_m(u, v, model.disparity(u, v)));
    corners.push_back({on_road[0], on_road[1]});
  }
  return corners;
}

}  // namespace roadstereo
