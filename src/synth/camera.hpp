#pragma once

#include "roadstereo/road_model.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::synth {

struct Vec3 {
  double x = 0;
  double y = 0;
  double z = 0;

  Vec3 operator+(const Vec3& o) const { return {x + o.x, y + o.y, z + o.z}; }
  Vec3 operator*(double s) const { return {x * s, y * s, z * s}; }
};

/// A line of sight in the road's frame. The direction has length 1 along the optical axis, so that the
/// parameter of a point on the ray is its depth Z in the camera.
struct Ray {
  Vec3 origin;
  Vec3 direction;

  Vec3 at(double depth) const { return origin + direction * depth; }
};

/// A pinhole camera over the road.
struct Camera {
  Vec3 origin;
  Vec3 right;  ///< x axis of the camera frame
  Vec3 down;   ///< y axis
  Vec3 forward;
  double focal_px = 0;
  double cx_px = 0;
  double cy_px = 0;

  Ray ray(double u, double v) const {
    return {origin, forward + right * ((u - cx_px) / focal_px) + down * ((v - cy_px) / focal_px)};
  }
};

Camera left_camera(const Rig& rig);

/// The right camera, whose image lies `row_offset_px` lower than a rectified one.
Camera right_camera(const Rig& rig, double row_offset_px);

/// Disparity of the plane Z = 0 as a function of the left pixel.
RoadModel plane_model(const Rig& rig);

/// ψ of a plane in disparity space, in (−π/2, π/2]; 0 when the disparity does not change over the image.
double paper_roll(const RoadModel& plane);

/// What one pixel covers of the road, along X and along Y, metres.
struct Footprint {
  double x = 0;
  double y = 0;
};

/// Footprints on the plane Z = 0, as seen from the middle between the two cameras: so both pictures of a
/// point have the same sharpness.
class FootprintModel {
 public:
  /// `to_middle_m` is the way from the camera to the middle along its x axis.
  FootprintModel(const Camera& camera, double to_middle_m);
  Footprint at(double depth, double u, double v) const;

 private:
  Camera camera_;
  double to_middle_m_;
  double inverse_depth_per_column_ = 0;  ///< d(1/Z)/du on the plane
  double inverse_depth_per_row_ = 0;
};

}  // namespace roadstereo::synth
