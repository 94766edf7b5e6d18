#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "roadstereo/damage.hpp"
#include "roadstereo/road_map.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Cells of a map, sorted by row, then by column.
using MapCells = std::vector<std::array<std::int32_t, 2>>;

/// Damage at a position of a map.
struct MapDamage {
  Damage damage;                 ///< `metrics` in metres; pixel coordinates are those of the frame, or of the window of
                                 ///< the map, in which it was found
  std::array<double, 2> at_m{};  ///< (x, y) of the centroid in the map
  double length_angle_rad = 0;   ///< from the map's x axis to the longer side, positive towards y, −π/2 … π/2
  MapCells footprint;            ///< cells of `footprint_m` that it covers
};

/// Side of the cells of footprints, metres.
inline constexpr double footprint_m = 0.02;

/// Finds damage in the heights of the map, window by window; the windows overlap. The heights above the plane of a
/// window are converted to the disparities of a virtual rig that looks straight down and whose pixels are the cells,
/// and searched by `find_damage`. The scale is chosen so that the median standard error of the window is 0.1 px. A
/// damage that one window cuts is taken from the window that contains it. Ruts are looked for along the nearest part of
/// `paths`, (x, y) of the camera in the map; without any, as DamageOptions::mount_yaw_deg says of a camera whose
/// picture has the map's y axis upwards. Throws Error when an option is out of range.
std::vector<MapDamage> find_map_damage(const RoadMap& map, const DamageOptions& options,
                                       std::span<const std::vector<std::array<double, 2>>> paths = {});

/// Returns the damages of a frame at their positions in the map. `found`: result of `find_damage`; damages without
/// metric values and candidates are left out.
std::vector<MapDamage> locate_damage(const DamageMap& found, const DisparityPlane& road,
                                     const StereoCalibration& calibration, const RigidTransform& camera_to_map);

}  // namespace roadstereo
#pragma GCC visibility pop
