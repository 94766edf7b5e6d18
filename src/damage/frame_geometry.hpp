#pragma once

#include <array>

#include "roadstereo/damage.hpp"

namespace roadstereo {

/// Rays of one frame against its road. Needs everything that is metric.
class FrameGeometry {
 public:
  using Point = std::array<double, 3>;

  explicit FrameGeometry(const DamageInput& input);

  /// Disparity of the undamaged surface, whose ℓ' is `surface`.
  double road_disparity(int u, int v, double surface) const { return model_.disparity(u, v) + surface - delta_t_; }
  Point point(int u, int v, double disparity) const { return calibration_.point_m(u, v, disparity); }
  /// Area of the road that one pixel covers where it lies at `road`: Z³ / (f²·n·P).
  double pixel_area(const Point& road) const;
  /// Depth along the normal between two points of one ray.
  double depth_between(const Point& road, const Point& seen) const;
  /// Metres of depth per pixel of disparity: n·P / (d + doffs).
  double metres_per_pixel(const Point& seen, double disparity) const;
  const RoadFrame& frame() const { return frame_; }
  double focal_px() const { return calibration_.focal_px; }

  /// Turns a row's depths from pixels of ℓ' to metres along the road's normal; `surface` is ℓ' of the undamaged road.
  void depths_to_metres(int v, int width, const float* surface, float* depths) const;

 private:
  StereoCalibration calibration_;
  RoadModel model_;
  RoadPlane plane_;
  RoadFrame frame_;
  double delta_t_ = 0;
};

}  // namespace roadstereo
