#include "damage/local_ground_plane.hpp"

#include <cmath>

#include "road/plane_fit.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pixel_box.hpp"

namespace roadstereo {

void require_same_size(const DamageMap& map, ImageView<const float> disparity) {
  if (disparity.empty() || (disparity.width() == map.ids.width() && disparity.height() == map.ids.height())) return;
  fail("the disparity map has ", disparity.width(), "×", disparity.height(), " pixels; it must have ", map.ids.width(),
       "×", map.ids.height(), " like the damage map");
}

LocalGroundPlane::LocalGroundPlane(const DisparityPlane& plane, const StereoCalibration& calibration)
    : calibration_(calibration), ground_plane_(ground_plane(plane, calibration)), axes_(road_axes(ground_plane_)) {}

std::array<double, 3> LocalGroundPlane::camera_point(double u, double v) const {
  const double x = (u - calibration_.cx_px) / calibration_.focal_px;
  const double y = (v - calibration_.cy_px) / calibration_.focal_px;
  const std::array<double, 3>& n = ground_plane_.normal;
  const double z = ground_plane_.height_m / (n[0] * x + n[1] * y + n[2]);
  return {x * z, y * z, z};
}

std::array<double, 2> LocalGroundPlane::road_point(double u, double v) const {
  const std::array<double, 3> on_road = axes_.to_road(camera_point(u, v));
  return {on_road[0], on_road[1]};
}

std::array<double, 2> LocalGroundPlane::image_direction(double u, double v, double angle_rad) const {
  const std::array<double, 3> p = camera_point(u, v);
  const double along_x = std::cos(angle_rad), along_y = std::sin(angle_rad);
  const auto component = [&](std::size_t i) { return along_x * axes_.x[i] + along_y * axes_.y[i]; };
  // Derivative of the projection, times Z².
  const double du = component(0) * p[2] - component(2) * p[0];
  const double dv = component(1) * p[2] - component(2) * p[1];
  const double length = std::hypot(du, dv);
  if (!(length > 0)) return {1, 0};
  return {du / length, dv / length};
}

std::optional<LocalGroundPlane> fit_local_ground_plane(const DamageMap& map, const Damage& damage,
                                                       ImageView<const float> disparity,
                                                       const std::optional<StereoCalibration>& calibration) {
  constexpr int min_pixels = 30;
  constexpr double margin_share = 0.5;
  constexpr int min_margin_px = 12;
  if (!map.metric || !calibration || disparity.empty()) return std::nullopt;
  const PixelBox box = box_with_margin(map, damage, margin_share, min_margin_px);
  PlaneSums sums(box.u0, box.v0);
  for (int v = box.v0; v <= box.v1; ++v) {
    for (int u = box.u0; u <= box.u1; ++u) {
      const bool intact = map.ids(u, v) == 0 && map.road(u, v) != 0 && std::isfinite(disparity(u, v));
      if (intact) sums.add({static_cast<double>(u), static_cast<double>(v), disparity(u, v)});
    }
  }
  if (sums.weight() < min_pixels) return std::nullopt;
  const std::optional<DisparityPlane> plane = sums.plane();
  if (!plane) return std::nullopt;
  return LocalGroundPlane(*plane, *calibration);
}

}  // namespace roadstereo
