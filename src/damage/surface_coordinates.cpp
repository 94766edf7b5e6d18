#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "damage/road_surface.hpp"
#include "roadstereo/ground_plane.hpp"

namespace roadstereo {
namespace {

/// Image coordinates, −1 … 1, and scale 1.
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

/// Component along an axis of the road of the ray through column u at z = 1: offset + slope·u.
struct RayComponent {
  double offset = 0;
  double slope = 0;
};

/// Component of the rays of image row v.
RayComponent ray_component(const StereoCalibration& calibration, const std::array<double, 3>& axis, double v) {
  const double f = calibration.focal_px;
  const double down = axis[1] * (v - calibration.cy_px) / f;
  return {axis[2] + down - axis[0] * calibration.cx_px / f, axis[0] / f};
}

/// Coordinates on the road, metres, and pixels of ℓ' per metre of height. A point on the plane has n·p = h. Raising it
/// by z at a fixed pixel scales its distance by 1 − z/h, so that its disparity grows by (d + doffs)·z/h to first order.
SurfaceCoordinates road_coordinates(const Cells& cells, const DisparityPlane& model,
                                    const StereoCalibration& calibration, int threads) {
  constexpr int rows_per_band = 16;
  constexpr double min_disparity_px = 2;
  constexpr double max_row_m = 1;  // maximum length of the road in one row of pixels
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  SurfaceCoordinates c;
  c.x.resize(cells.width(), cells.height());
  c.y.resize(cells.width(), cells.height());
  c.scale.resize(cells.width(), cells.height());
  const GroundPlane plane = ground_plane(model, calibration);
  const RoadAxes axes = road_axes(plane);
  const std::array<double, 3> camera = axes.to_road({0, 0, 0});
  const double fb = calibration.focal_px * calibration.baseline_m;
  const double max_depth_m = std::sqrt(max_row_m * calibration.focal_px * plane.height_m);  // row: Z²/(f·h)
  const double min_disparity = std::max(min_disparity_px, fb / max_depth_m);
  const auto fill_row = [&](int j) {
    const double v = cells.middle(j);
    const RayComponent ray_x = ray_component(calibration, axes.x, v);
    const RayComponent ray_y = ray_component(calibration, axes.y, v);
    float* const x = c.x.row(j);
    float* const y = c.y.row(j);
    float* const scale = c.scale.row(j);
    for (int i = 0; i < cells.width(); ++i) {
      const double u = cells.middle(i);
      const double disparity = model.disparity(u, v) + calibration.disparity_offset_px;
      const double z = fb / disparity;
      const bool valid = disparity >= min_disparity;
      x[i] = valid ? static_cast<float>(camera[0] + z * (ray_x.offset + ray_x.slope * u)) : nan;
      y[i] = valid ? static_cast<float>(camera[1] + z * (ray_y.offset + ray_y.slope * u)) : nan;
      scale[i] = valid ? static_cast<float>(disparity / plane.height_m) : nan;
    }
  };
  parallel_rows(cells.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) fill_row(j);
  });
  return c;
}

}  // namespace

SurfaceCoordinates surface_coordinates(const Cells& cells, const DamageInput& input, int threads) {
  if (input.plane && input.calibration) return road_coordinates(cells, *input.plane, *input.calibration, threads);
  return image_coordinates(cells);
}

}  // namespace roadstereo
