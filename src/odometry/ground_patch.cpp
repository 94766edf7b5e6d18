#include "odometry/ground_patch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace roadstereo {
namespace {

/// Point of the camera frame at road coordinates (x, y, 0).
Vector<3> from_road(const RoadAxes& axes, double x, double y) {
  Vector<3> p{};
  for (std::size_t i = 0; i < 3; ++i) p[i] = axes.origin_m[i] + x * axes.x[i] + y * axes.y[i];
  return p;
}

/// Road coordinates where a pixel meets the plane.
std::array<double, 2> meet_road(const DisparityPlane& plane, const StereoCalibration& calibration, const RoadAxes& axes,
                                double u, double v) {
  const std::array<double, 3> on_road = axes.to_road(calibration.point_m(u, v, plane.disparity(u, v)));
  return {on_road[0], on_road[1]};
}

constexpr int side = GroundGrid::side;

/// Sums of the cells above and to the left, (side + 1)².
std::vector<double> integral(const std::vector<float>& values) {
  constexpr std::size_t stride = side + 1;
  std::vector<double> sums(stride * stride, 0);
  for (std::size_t y = 0; y < side; ++y) {
    double row = 0;
    for (std::size_t x = 0; x < side; ++x) {
      row += static_cast<double>(values[y * side + x]);
      sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row;
    }
  }
  return sums;
}

/// Sum of the cells up to `radius` away.
double box_sum(const std::vector<double>& sums, int x, int y, int radius) {
  const int x0 = std::max(x - radius, 0), x1 = std::min(x + radius + 1, side);
  const int y0 = std::max(y - radius, 0), y1 = std::min(y + radius + 1, side);
  const auto at = [&sums](int column, int row) {
    return sums[static_cast<std::size_t>(row) * (side + 1) + static_cast<std::size_t>(column)];
  };
  return at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0);
}

/// Subtracts the mean of 9×9 cells and tapers to the border of the valid ones.
void filter(std::vector<float>& cells, const std::vector<float>& valid) {
  constexpr int radius = 4;
  constexpr double full = (2 * radius + 1) * (2 * radius + 1);
  const std::vector<double> grey = integral(cells), count = integral(valid);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const auto i = static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x);
      if (valid[i] == 0) continue;
      const double neighbours = box_sum(count, x, y, radius);
      const double detail = static_cast<double>(cells[i]) - box_sum(grey, x, y, radius) / neighbours;
      cells[i] = static_cast<float>(detail * neighbours / full);
    }
  }
}

}  // namespace

bool frame_road(const DisparityPlane& plane, const StereoCalibration& calibration, int width, int height,
                FrameRoad& road) {
  constexpr double max_stretch = 4;
  road.plane = ground_plane(plane, calibration);
  road.axes = road_axes(road.plane);
  const auto inverse_depth = [&](double u, double v) {  // f·b/Z, pixels
    return plane.disparity(u, v) + calibration.disparity_offset_px;
  };
  const double at_bottom = inverse_depth(calibration.cx_px, height - 1);
  if (!(at_bottom > 0)) return false;
  int top = height - 1;
  while (top > 0 && inverse_depth(calibration.cx_px, top - 1) * max_stretch > at_bottom) --top;
  if (height - top < height / 8) return false;
  const double left = 0.1 * width, right = 0.9 * width;
  double x0 = INFINITY, x1 = -INFINITY, y0 = INFINITY, y1 = -INFINITY;
  for (const double u : {left, right}) {
    for (const int v : {top, height - 1}) {
      if (!(inverse_depth(u, v) > 0)) continue;
      const auto [x, y] = meet_road(plane, calibration, road.axes, u, v);
      if (v == height - 1) x0 = std::min(x0, x), x1 = std::max(x1, x);
      y0 = std::min(y0, y);
      y1 = std::max(y1, y);
    }
  }
  if (!(x1 > x0 && y1 > y0)) return false;
  road.grid.cell_m = std::max(x1 - x0, y1 - y0) / GroundGrid::side;
  road.grid.centre_x_m = (x0 + x1) / 2;
  road.grid.centre_y_m = (y0 + y1) / 2;
  return true;
}

void sample_ground(const ImagePyramid& pyramid, const StereoCalibration& calibration, const FrameRoad& road,
                   const GroundGrid& grid, double yaw_rad, std::vector<float>& cells) {
  cells.assign(static_cast<std::size_t>(side) * side, 0);
  std::vector<float> valid(cells.size(), 0);
  const double cosine = std::cos(yaw_rad), sine = std::sin(yaw_rad);
  constexpr int middle = side / 2;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const double dx = (column - middle) * grid.cell_m, dy = (row - middle) * grid.cell_m;
      const Vector<3> p =
          from_road(road.axes, grid.centre_x_m + cosine * dx - sine * dy, grid.centre_y_m + sine * dx + cosine * dy);
      if (!(p[2] > 0)) continue;
      const double u = calibration.focal_px * p[0] / p[2] + calibration.cx_px;
      const double v = calibration.focal_px * p[1] / p[2] + calibration.cy_px;
      // The level whose pixels are as large as the cells.
      const double pixels = grid.cell_m * calibration.focal_px / p[2];
      int level = 0;
      while (level + 1 < pyramid.levels() && pixels > std::numbers::sqrt2 * (1 << level)) ++level;
      const ImageView<const std::int16_t> grey = pyramid.level(level);
      const double scale = 1.0 / (1 << level), x = (u + 0.5) * scale, y = (v + 0.5) * scale;
      if (!(x >= 0 && y >= 0 && x < grey.width() && y < grey.height())) continue;
      const auto i = static_cast<std::size_t>(row) * side + static_cast<std::size_t>(column);
      cells[i] = static_cast<float>(grey.row(static_cast<int>(y))[static_cast<int>(x)]) * grey_unit;
      valid[i] = 1;
    }
  }
  filter(cells, valid);
}

RigidMotion planar_motion(const FrameRoad& from, const FrameRoad& to, double yaw_rad, double x_m, double y_m) {
  const auto camera_from_road = [](const RoadAxes& axes) {
    RigidMotion motion;
    for (std::size_t i = 0; i < 3; ++i) motion.rotation[i] = {axes.x[i], axes.y[i], axes.z[i]};
    motion.translation = axes.origin_m;
    return motion;
  };
  const double cosine = std::cos(yaw_rad), sine = std::sin(yaw_rad);
  RigidMotion planar;
  planar.rotation = {{{cosine, -sine, 0}, {sine, cosine, 0}, {0, 0, 1}}};
  planar.translation = {x_m, y_m, 0};
  return camera_from_road(to.axes) * planar * inverse(camera_from_road(from.axes));
}

}  // namespace roadstereo
