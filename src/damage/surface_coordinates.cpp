#include <algorithm>
#include <array>
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

/// A coordinate of the ray through column u of a row, at z = 1, along an axis of the road: first + step·u.
struct AlongRow {
  double first = 0;
  double step = 0;
};

AlongRow along_row(const StereoCalibration& calibration, const std::array<double, 3>& axis, double v) {
  const double f = calibration.focal_px;
  const double down = axis[1] * (v - calibration.cy_px) / f;
  return {axis[2] + down - axis[0] * calibration.cx_px / f, axis[0] / f};
}

/// A point on the plane has n·p = h; lifting it by z at a fixed pixel brings it nearer by the factor 1 − z/h, so that
/// its disparity grows by (d + doffs)·z/h to first order.
SurfaceCoordinates road_coordinates(const Cells& cells, const RoadModel& model, const StereoCalibration& calibration) {
  constexpr double least_disparity_px = 2;
  constexpr double longest_row_m = 1;  // of the road that a row of pixels covers: farther away nothing can be measured
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  SurfaceCoordinates c;
  c.x.resize(cells.width(), cells.height());
  c.y.resize(cells.width(), cells.height());
  c.scale.resize(cells.width(), cells.height());
  const RoadPlane plane = road_plane(model, calibration);
  const RoadFrame frame = road_frame(plane);
  const std::array<double, 3> camera = frame.to_road({0, 0, 0});
  const double fb = calibration.focal_px * calibration.baseline_m;
  const double farthest_m = std::sqrt(longest_row_m * calibration.focal_px * plane.height_m);
  const double least = std::max(least_disparity_px, fb / farthest_m);
  for (int j = 0; j < cells.height(); ++j) {
    const double v = cells.middle(j);
    const AlongRow x = along_row(calibration, frame.x, v);
    const AlongRow y = along_row(calibration, frame.y, v);
    float* const to_x = c.x.row(j);
    float* const to_y = c.y.row(j);
    float* const to_scale = c.scale.row(j);
    for (int i = 0; i < cells.width(); ++i) {
      const double u = cells.middle(i);
      const double disparity = model.disparity(u, v) + calibration.disparity_offset_px;
      const double z = fb / disparity;
      const bool measurable = disparity >= least;
      to_x[i] = measurable ? static_cast<float>(camera[0] + z * (x.first + x.step * u)) : nan;
      to_y[i] = measurable ? static_cast<float>(camera[1] + z * (y.first + y.step * u)) : nan;
      to_scale[i] = measurable ? static_cast<float>(disparity / plane.height_m) : nan;
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
