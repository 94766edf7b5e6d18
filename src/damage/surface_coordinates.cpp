#include <cmath>
#include <limits>

#include "damage/road_surface.hpp"
#include "roadstereo/road_plane.hpp"

namespace roadstereo {
namespace {

SurfaceCoordinates image_coordinates(const Cells& cells) {
  SurfaceCoordinates c;
  c.x.resize(cells.width(), cells.height());
  c.y.resize(cells.width(), cells.height());
  c.scale.assign(cells.width(), cells.height(), 1.0F);
  for (int j = 0; j < cells.height(); ++j) {
    for (int i = 0; i < cells.width(); ++i) {
      c.x(i, j) = static_cast<float>(2.0 * i / cells.width() - 1);
      c.y(i, j) = static_cast<float>(2.0 * j / cells.height() - 1);
    }
  }
  return c;
}

/// A point on the plane has n·p = h; lifting it by z at a fixed pixel brings it nearer by the factor 1 − z/h, so that
/// its disparity grows by (d + doffs)·z/h to first order.
SurfaceCoordinates road_coordinates(const Cells& cells, const RoadModel& model, const StereoCalibration& calibration) {
  constexpr double least_disparity_px = 2;
  constexpr double longest_row_m = 1;  // of the road that a row of pixels covers: farther away nothing can be measured
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  SurfaceCoordinates c;
  c.x.assign(cells.width(), cells.height(), nan);
  c.y.assign(cells.width(), cells.height(), nan);
  c.scale.assign(cells.width(), cells.height(), nan);
  const RoadPlane plane = road_plane(model, calibration);
  const RoadFrame frame = road_frame(plane);
  for (int j = 0; j < cells.height(); ++j) {
    for (int i = 0; i < cells.width(); ++i) {
      const double u = cells.middle(i);
      const double v = cells.middle(j);
      const double disparity = model.disparity(u, v);
      if (disparity + calibration.disparity_offset_px < least_disparity_px) continue;
      const double z = calibration.depth_m(disparity);
      if (z * z > longest_row_m * calibration.focal_px * plane.height_m) continue;
      const std::array<double, 3> point = frame.to_road(calibration.point_m(u, v, disparity));
      c.x(i, j) = static_cast<float>(point[0]);
      c.y(i, j) = static_cast<float>(point[1]);
      c.scale(i, j) = static_cast<float>((disparity + calibration.disparity_offset_px) / plane.height_m);
    }
  }
  return c;
}

}  // namespace

SurfaceCoordinates surface_coordinates(const Cells& cells, const DamageInput& input) {
  if (input.plane && input.calibration) return road_coordinates(cells, *input.plane, *input.calibration);
  return image_coordinates(cells);
}

}  // namespace roadstereo
