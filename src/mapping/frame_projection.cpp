#include "mapping/frame_projection.hpp"

#include <algorithm>
#include <cmath>

#include "roadstereo/error.hpp"
#include "roadstereo/ground_plane.hpp"

namespace roadstereo {
FrameProjection::FrameProjection(const MapFrame& frame, const RoadMapOptions& options)
    : frame_(frame),
      options_(options),
      map_to_camera_(inverse(frame.camera_to_map)),
      colours_(frame.image, frame.white_level) {
  const GroundPlane plane = ground_plane(frame.road, frame.calibration);
  const std::array<double, 3> normal = rotate(frame.camera_to_map, plane.normal);  // downwards
  const std::array<double, 3> foot = transform_point(
      frame.camera_to_map,
      {plane.height_m * plane.normal[0], plane.height_m * plane.normal[1], plane.height_m * plane.normal[2]});
  constexpr double min_vertical = 0.342;  // cos 70°
  if (!(normal[2] < -min_vertical)) {
    fail("the road of a frame is inclined by more than 70° in the map: its pose, or the axis that points up, is wrong");
  }
  slope_x_ = -normal[0] / normal[2];
  slope_y_ = -normal[1] / normal[2];
  offset_ = foot[2] - slope_x_ * foot[0] - slope_y_ * foot[1];
  normal_height_m_ = plane.height_m;
}

std::optional<std::array<double, 2>> FrameProjection::pixel_of(double x, double y, double z) const {
  const std::array<double, 3> p = transform_point(map_to_camera_, {x, y, z});
  if (!(p[2] > 0)) return std::nullopt;
  const StereoCalibration& rig = frame_.calibration;
  const double u = rig.cx_px + rig.focal_px * p[0] / p[2];
  const double v = rig.cy_px + rig.focal_px * p[1] / p[2];
  if (!(u >= 0 && v >= 0 && u <= frame_.disparity.width() - 1 && v <= frame_.disparity.height() - 1))
    return std::nullopt;
  return std::array<double, 2>{u, v};
}

/// Bilinear interpolation where the four pixels are of one surface, else the nearest pixel.
std::optional<double> FrameProjection::disparity_at(double u, double v) const {
  constexpr float max_step_px = 1;
  const int u0 = std::min(static_cast<int>(u), frame_.disparity.width() - 2);
  const int v0 = std::min(static_cast<int>(v), frame_.disparity.height() - 2);
  const float a = frame_.disparity(u0, v0), b = frame_.disparity(u0 + 1, v0);
  const float c = frame_.disparity(u0, v0 + 1), d = frame_.disparity(u0 + 1, v0 + 1);
  const double along = u - u0, down = v - v0;
  const auto [lowest, highest] = std::minmax({a, b, c, d});
  if (std::isnan(a + b + c + d) || highest - lowest > max_step_px) {
    const float nearest = down < 0.5 ? (along < 0.5 ? a : b) : (along < 0.5 ? c : d);
    return std::isnan(nearest) ? std::nullopt : std::optional<double>(nearest);
  }
  const double above = a + along * (b - a);
  const double below = c + along * (d - c);
  return above + down * (below - above);
}

/// Whether a pixel covers little enough of the road along its line of sight: Z²/(f·h).
bool FrameProjection::is_sharp(double u, double v) const {
  const double disparity = frame_.road.disparity(u, v) + frame_.calibration.disparity_offset_px;
  if (!(disparity > 0)) return false;
  const double z = frame_.calibration.focal_px * frame_.calibration.baseline_m / disparity;
  const double along = z * z / (frame_.calibration.focal_px * normal_height_m_);
  return along <= options_.max_footprint_cells * options_.cell_m;
}

MapBox FrameProjection::footprint() const {
  constexpr int step = 4;
  const int width = frame_.disparity.width(), height = frame_.disparity.height();
  double x0 = INFINITY, x1 = -INFINITY, y0 = INFINITY, y1 = -INFINITY;
  for (int v = 0; v < height + step - 1; v += step) {
    for (int u = 0; u < width + step - 1; u += step) {
      const int column = std::min(u, width - 1), row = std::min(v, height - 1);
      if (!is_sharp(column, row)) continue;
      const std::array<double, 3> p = transform_point(
          frame_.camera_to_map, frame_.calibration.point_m(column, row, frame_.road.disparity(column, row)));
      x0 = std::min(x0, p[0]);
      x1 = std::max(x1, p[0]);
      y0 = std::min(y0, p[1]);
      y1 = std::max(y1, p[1]);
    }
  }
  if (!(x0 <= x1)) return {};
  constexpr double outside = max_map_cell + 1;  // which a map refuses
  const auto cell = [&](double metres) {
    return static_cast<int>(std::clamp(std::floor(metres / options_.cell_m), -outside, outside));
  };
  return {cell(x0), cell(y0), cell(x1) - cell(x0) + 1, cell(y1) - cell(y0) + 1};
}

std::optional<CellMeasurement> FrameProjection::measure(double x, double y) const {
  constexpr int max_iterations = 8;
  constexpr double tolerance_px = 0.25;
  const StereoCalibration& rig = frame_.calibration;
  const double road = offset_ + slope_x_ * x + slope_y_ * y;
  double z = road;
  std::optional<std::array<double, 2>> pixel = pixel_of(x, y, z);
  if (!pixel || !is_sharp((*pixel)[0], (*pixel)[1])) return std::nullopt;
  for (int i = 0; i < max_iterations; ++i) {
    const auto [u, v] = *pixel;
    const std::optional<double> disparity = disparity_at(u, v);
    if (!disparity || !(*disparity + rig.disparity_offset_px > 0)) return std::nullopt;
    const std::array<double, 3> p = rig.point_m(u, v, *disparity);
    const std::array<double, 3> point = transform_point(frame_.camera_to_map, p);
    z = point[2];
    if (z - road > options_.max_above_m || road - z > options_.max_below_m) return std::nullopt;
    const std::optional<std::array<double, 2>> next = pixel_of(x, y, z);
    if (!next) return std::nullopt;
    const double change = std::hypot((*next)[0] - u, (*next)[1] - v);
    pixel = next;
    if (change > tolerance_px) continue;
    const float sigma = frame_.sigma(static_cast<int>(std::lround(u)), static_cast<int>(std::lround(v)));
    if (!std::isfinite(sigma) || sigma <= 0) return std::nullopt;
    // A disparity that is larger by δ moves the point by δ / (d + doffs) of the way to the camera.
    const double climb = frame_.camera_to_map[11] - z;
    const double metres_per_px = climb / (*disparity + rig.disparity_offset_px);
    CellMeasurement result;
    result.height = static_cast<float>(z);
    result.variance = static_cast<float>(metres_per_px * metres_per_px * sigma * sigma);
    result.sharpness = static_cast<float>(rig.focal_px * rig.focal_px * normal_height_m_ / (p[2] * p[2] * p[2]));
    result.colour = colours_.at(u, v);
    if (!(result.variance > 0)) return std::nullopt;
    return result;
  }
  return std::nullopt;
}

}  // namespace roadstereo
