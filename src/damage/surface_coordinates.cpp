#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "damage/frame_geometry.hpp"
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

/// A value that is linear in the column of cells.
class Line {
 public:
  Line(double first, double step) : first_(static_cast<float>(first)), step_(static_cast<float>(step)) {}
  float at(int i) const { return first_ + step_ * static_cast<float>(i); }

 private:
  float first_, step_;
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
                                    const StereoCalibration& calibration, double min_disparity_px, int threads) {
  constexpr int rows_per_band = 16;
  constexpr double max_row_m = 1;  // maximum length of the road in one row of pixels
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  SurfaceCoordinates c;
  c.is_on_road = true;
  c.x.resize(cells.width(), cells.height());
  c.y.resize(cells.width(), cells.height());
  c.scale.resize(cells.width(), cells.height());
  const GroundPlane plane = ground_plane(model, calibration);
  const RoadAxes axes = road_axes(plane);
  const std::array<double, 3> camera = axes.to_road({0, 0, 0});
  const double fb = calibration.focal_px * calibration.baseline_m;
  const double max_depth_m = std::sqrt(max_row_m * calibration.focal_px * plane.height_m);  // row: Z²/(f·h)
  const double min_disparity = std::max(min_disparity_px, fb / max_depth_m);
  // Of every column: the disparity is linear in it, as are the rays.
  const auto min_valid = static_cast<float>(min_disparity), focal_baseline = static_cast<float>(fb);
  const auto camera_x = static_cast<float>(camera[0]), camera_y = static_cast<float>(camera[1]);
  const auto per_metre = static_cast<float>(1 / plane.height_m);
  const auto fill_row = [&](int j) {
    const double v = cells.middle(j), first = cells.middle(0), step = cells.middle(1) - first;
    const RayComponent ray_x = ray_component(calibration, axes.x, v);
    const RayComponent ray_y = ray_component(calibration, axes.y, v);
    const Line disparities(model.disparity(first, v) + calibration.disparity_offset_px, model.a2 * step);
    const Line rays_x(ray_x.offset + ray_x.slope * first, ray_x.slope * step);
    const Line rays_y(ray_y.offset + ray_y.slope * first, ray_y.slope * step);
    float* const x = c.x.row(j);
    float* const y = c.y.row(j);
    float* const scale = c.scale.row(j);
    for (int i = 0; i < cells.width(); ++i) {
      const float disparity = disparities.at(i), z = focal_baseline / disparity;
      const bool valid = disparity >= min_valid;
      x[i] = valid ? camera_x + z * rays_x.at(i) : nan;
      y[i] = valid ? camera_y + z * rays_y.at(i) : nan;
      scale[i] = valid ? disparity * per_metre : nan;
    }
  };
  parallel_rows(cells.height(), rows_per_band, threads, [&](int first, int last, int) {
    for (int j = first; j < last; ++j) fill_row(j);
  });
  return c;
}

}  // namespace

double SurfaceCoordinates::aspect(int i, int j) const {
  if (!is_on_road) return 1;
  const int left = std::max(i - 1, 0), right = std::min(i + 1, x.width() - 1);
  const int top = std::max(j - 1, 0), bottom = std::min(j + 1, x.height() - 1);
  const auto distance_m = [this](int i0, int j0, int i1, int j1) {
    return std::hypot(double{x(i1, j1)} - x(i0, j0), double{y(i1, j1)} - y(i0, j0));
  };
  const double column_m = distance_m(left, j, right, j) / (right - left);
  const double row_m = distance_m(i, top, i, bottom) / (bottom - top);
  const double aspect = column_m / row_m;
  return std::isnan(aspect) ? 1 : std::min(aspect, 1.0);
}

SurfaceCoordinates surface_coordinates(const Cells& cells, const DamageInput& input, int threads) {
  if (!input.plane) return image_coordinates(cells);
  constexpr double min_disparity_px = 2, any_disparity_px = 0;  // without a calibration the unit may be any
  if (input.calibration) {
    SurfaceCoordinates metric = road_coordinates(cells, *input.plane, *input.calibration, min_disparity_px, threads);
    metric.is_metric = true;
    return metric;
  }
  const StereoCalibration assumed = assumed_calibration(*input.plane, cells.image_width, cells.image_height);
  return road_coordinates(cells, *input.plane, assumed, any_disparity_px, threads);
}

}  // namespace roadstereo
