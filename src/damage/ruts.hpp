#pragma once

#include <vector>

#include "damage/road_surface.hpp"

namespace roadstereo {

/// Least depth of a rut below its straightedge, standard errors.
inline constexpr double min_rut_sigmas = 14;

/// Ruts: strips along the road, in one direction up to 30° from that of travel, that lie below a straightedge across
/// it.
struct Ruts {
  Image<std::uint8_t> labels;         ///< number of the rut of each cell, 1 …; 0: none; empty without ruts
  Image<float> depth_m;               ///< of each cell below the straightedge, mean of its rut; 0 outside
  std::vector<float> floors_m;        ///< depth below the straightedge of each
  std::vector<double> significances;  ///< that in its standard errors

  bool empty() const { return significances.empty(); }
  /// Set the cells of all ruts.
  void fill(std::uint8_t value, Image<std::uint8_t>& mask) const;
};

/// Find ruts; none without metric coordinates. Ruts continue along the road, and a pair of wheel tracks covers half of
/// a lane, so that a robust fit does not treat them as outliers: the surface of the road must be fitted without them.
/// `mount_yaw_deg`: DamageOptions::mount_yaw_deg.
Ruts find_ruts(const Cells& cells, const SurfaceCoordinates& coordinates, const RoadSurface& surface,
               double mount_yaw_deg, int threads);

}  // namespace roadstereo
