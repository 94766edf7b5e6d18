#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "roadstereo/io/track.hpp"
#include "roadstereo/pose_graph.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Axes at a fix of a track, x east, y north, z up, metres, and the UTM zone around it (WGS84): the middle one of those
/// within a time, or of all if none is. Lengths in UTM differ from those on the ground by −0.04 to +0.1 %; in these
/// axes they do not. The constructor throws Error at a latitude without UTM (near the poles), and in a build without
/// GDAL and GeographicLib.
class LocalAxes {
 public:
  explicit LocalAxes(const Track& track, double from_s = -std::numeric_limits<double>::infinity(),
                     double to_s = std::numeric_limits<double>::infinity());

  /// The fixes of the track. Where the track has no accuracies, those of `PositionFix` are used.
  const std::vector<PositionFix>& fixes() const { return fixes_; }

  /// The coordinate system of `to_utm`, e.g. "EPSG:32632".
  const std::string& crs() const { return crs_; }

  /// Moves a pose (3×4, row-major, metres) from these axes to UTM: x east, y north of the grid, z altitude.
  std::array<double, 12> to_utm(const std::array<double, 12>& pose) const;

  /// Position of a camera whose pose is given in these axes (3×4, row-major, metres), with the direction of its upper
  /// image border over the ground as heading; NaN if its x axis is vertical.
  GeoPosition position(const std::array<double, 12>& pose) const;

 private:
  double lat_deg_ = 0, lon_deg_ = 0, alt_m_ = 0;  ///< of the origin
  int zone_ = 0;
  bool north_ = true;
  std::string crs_;
  std::vector<PositionFix> fixes_;
};

}  // namespace roadstereo::io
#pragma GCC visibility pop
