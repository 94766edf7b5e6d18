#pragma once

#include <array>

#include "roadstereo/damage.hpp"

namespace roadstereo {

/// Calibration assumed for a pair without one: the focal length is the width of the image, the camera is 1.5 m above
/// the road, and the disparities have no offset. The points of a plane, b/d·K⁻¹(u, v, 1), are linear in (u, v, 1)/d: a
/// wrong K and b give points that an affine map turns into the right ones.
StereoCalibration assumed_calibration(const DisparityPlane& model, int width, int height);

/// Metric geometry of the lines of sight of one frame and its undamaged road. Points are in the camera frame, metres.
class FrameGeometry {
 public:
  using Point = std::array<double, 3>;

  /// Whether `input` has what it takes: a disparity map and a plane.
  static bool is_possible(const DamageInput& input) { return input.plane && !input.disparity.empty(); }
  /// Without a calibration one is assumed: points are right up to an affine map, slopes in proportion to the focal
  /// length.
  explicit FrameGeometry(const DamageInput& input);

  /// Disparity of the undamaged road at a pixel, from its ℓ'.
  double road_disparity(int u, int v, double surface) const {
    return disparity_plane_.disparity(u, v) + surface - delta_t_;
  }
  Point point(int u, int v, double disparity) const { return calibration_.point_m(u, v, disparity); }
  /// (x, y) where the line of sight of (u, v) meets the road's plane, in the axes of `road_axes`.
  std::array<double, 2> road_position(double u, double v) const {
    const Point on_road = axes_.to_road(calibration_.point_m(u, v, disparity_plane_.disparity(u, v)));
    return {on_road[0], on_road[1]};
  }
  /// n·P: distance along the road's normal.
  double distance(const Point& point) const {
    const Point& n = ground_plane_.normal;
    return n[0] * point[0] + n[1] * point[1] + n[2] * point[2];
  }
  /// Depth along the road's normal from `road` to `measured`, two points of one line of sight.
  double depth_between(const Point& road, const Point& measured) const { return distance(measured) - distance(road); }
  /// Depth along the road's normal per pixel of disparity at `measured`, metres: n·P / (d + doffs).
  double metres_per_pixel(const Point& measured, double disparity) const {
    return distance(measured) / (disparity + calibration_.disparity_offset_px);
  }
  const RoadAxes& axes() const { return axes_; }
  const StereoCalibration& calibration() const { return calibration_; }

  /// Convert a row of depths in place from pixels of ℓ' to metres along the road's normal. `surface` is ℓ' of the
  /// undamaged road.
  void depths_to_metres(int v, int width, const float* surface, float* depths) const;

 private:
  StereoCalibration calibration_;
  DisparityPlane disparity_plane_;
  GroundPlane ground_plane_;
  RoadAxes axes_;
  double delta_t_ = 0;
};

}  // namespace roadstereo
