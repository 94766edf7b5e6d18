#pragma once

#include <array>
#include <optional>

#include "roadstereo/calibration.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/road_plane.hpp"

namespace roadstereo {

/// Throws Error naming the sizes unless the disparity map is empty or has the map's size.
void require_same_size(const DamageMap& map, ImageView<const float> disparity);

/// The intact road next to a damage as a plane in space: places pixels on it.
class LocalRoad {
 public:
  LocalRoad(const RoadModel& model, const StereoCalibration& calibration);

  /// Where the line of sight of (u, v) meets the plane, in the axes of the road (x to the camera's right, y forward),
  /// metres.
  std::array<double, 2> at(double u, double v) const;

  /// The direction in the image, a unit vector, of the direction on the road that leaves (u, v) at `angle_rad` from x
  /// towards y.
  std::array<double, 2> image_direction(double u, double v, double angle_rad) const;

 private:
  std::array<double, 3> point(double u, double v) const;

  StereoCalibration calibration_;
  RoadPlane plane_;
  RoadFrame frame_;
};

/// The plane through the intact road around the damage. Nothing without disparities and a calibration, when the map is
/// not metric, or when hardly any intact road is near.
std::optional<LocalRoad> find_local_road(const DamageMap& map, const Damage& damage, ImageView<const float> disparity,
                                         const std::optional<StereoCalibration>& calibration);

}  // namespace roadstereo
