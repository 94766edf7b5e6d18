#pragma once

#include <array>

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

/// Line of sight in the road frame. The direction has length 1 along the optical axis, so that the parameter of a point
/// is its depth Z in the camera.
struct Ray {
  Vec3 origin;
  Vec3 direction;

  Vec3 at(double depth) const { return origin + direction * depth; }
};

/// Pinhole camera in the road frame.
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

  /// Pixel (u, v) of a point in front of the camera.
  std::array<double, 2> project(const Vec3& point) const {
    const Vec3 to{point.x - origin.x, point.y - origin.y, point.z - origin.z};
    const auto along = [&to](const Vec3& axis) { return axis.x * to.x + axis.y * to.y + axis.z * to.z; };
    const double scale = focal_px / along(forward);
    return {cx_px + scale * along(right), cy_px + scale * along(down)};
  }
};

/// The rig while a row of the picture is exposed.
Rig rig_of_row(const Scene& scene, int row);

Camera left_camera(const Rig& rig);

/// Right camera, with its image shifted down and rotated by the errors of the rectification.
Camera right_camera(const Rig& rig, const Degradation& degradation = {});

/// Plane Z = 0 in the disparity space of the left camera.
DisparityPlane road_disparity_plane(const Rig& rig);

/// Roll angle ψ of a plane in disparity space, radians, (−π/2, π/2]; 0 if the disparity is constant.
double roll_angle(const DisparityPlane& plane);

/// Size of one pixel on the road along X and along Y, metres.
struct Footprint {
  double x = 0;
  double y = 0;
};

/// Pixel footprints on the plane Z = 0, seen from the midpoint between the two cameras, so that a point has the same
/// sharpness in both images.
class FootprintModel {
 public:
  FootprintModel() = default;
  /// `midpoint_offset_m`: offset of the midpoint from the camera along its x axis.
  FootprintModel(const Camera& camera, double midpoint_offset_m);
  Footprint at(double depth, double u, double v) const;

 private:
  Camera camera_;
  double midpoint_offset_m_ = 0;
  double inverse_depth_per_column_ = 0;  ///< d(1/Z)/du on the plane
  double inverse_depth_per_row_ = 0;     ///< d(1/Z)/dv
};

}  // namespace roadstereo::synth
