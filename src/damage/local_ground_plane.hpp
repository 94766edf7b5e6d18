#pragma once

#include <array>
#include <optional>

#include "roadstereo/calibration.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// Throws Error naming the sizes if the disparity map is not empty and its size differs from that of the map.
void require_same_size(const DamageMap& map, ImageView<const float> disparity);

/// Plane of the intact road around a damage, with the pose of the camera.
class LocalGroundPlane {
 public:
  LocalGroundPlane(const DisparityPlane& plane, const StereoCalibration& calibration);

  /// Intersection of the line of sight of pixel (u, v) with the plane: x to the camera's right, y forward, metres.
  std::array<double, 2> road_point(double u, double v) const;

  /// Direction in the image, a unit vector, of the direction on the road at `angle_rad` from x towards y, at pixel
  /// (u, v).
  std::array<double, 2> image_direction(double u, double v, double angle_rad) const;

 private:
  /// Intersection in the camera frame.
  std::array<double, 3> camera_point(double u, double v) const;

  StereoCalibration calibration_;
  GroundPlane ground_plane_;
  RoadAxes axes_;
};

/// Fit a plane to the disparities of the intact road around the damage by least squares. Empty if `disparity` or
/// `calibration` is missing, the map is not metric, or fewer than 30 intact pixels are near.
std::optional<LocalGroundPlane> fit_local_ground_plane(const DamageMap& map, const Damage& damage,
                                                       ImageView<const float> disparity,
                                                       const std::optional<StereoCalibration>& calibration);

}  // namespace roadstereo
