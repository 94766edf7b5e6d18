#include "roadstereo/road_plane.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo {

RoadPlane road_plane(const RoadModel& model, const StereoCalibration& calibration) {
  const double at_centre = model.disparity(calibration.cx_px, calibration.cy_px) + calibration.disparity_offset_px;
  const std::array<double, 3> g{model.a2, model.a1, at_centre / calibration.focal_px};
  const double length = std::hypot(g[0], g[1], g[2]);
  RoadPlane plane;
  plane.normal = {g[0] / length, g[1] / length, g[2] / length};
  plane.height_m = calibration.baseline_m / length;
  plane.pitch_rad = std::asin(std::clamp(plane.normal[2], -1.0, 1.0));
  return plane;
}

}  // namespace roadstereo
