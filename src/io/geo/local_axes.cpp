#include "roadstereo/io/local_axes.hpp"

#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <cmath>

#include "core/degrees.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {

LocalAxes::LocalAxes(const Track& track) {
  const TrackPoint& origin = track.points().front();
  lat_deg_ = origin.lat_deg;
  lon_deg_ = origin.lon_deg;
  alt_m_ = std::isnan(origin.alt_m) ? 0 : origin.alt_m;
  zone_ = GeographicLib::UTMUPS::StandardZone(lat_deg_, lon_deg_);
  north_ = lat_deg_ >= 0;
  if (zone_ < GeographicLib::UTMUPS::MINUTMZONE) fail("the track is at latitude ", lat_deg_, "°, where UTM ends");
  crs_ = "EPSG:" + std::to_string((north_ ? 32600 : 32700) + zone_);
  const GeographicLib::LocalCartesian local(lat_deg_, lon_deg_, alt_m_);
  for (const TrackPoint& point : track.points()) {
    PositionFix fix;
    fix.time_s = point.time_s;
    auto& [x, y, z] = fix.position_m;
    local.Forward(point.lat_deg, point.lon_deg, std::isnan(point.alt_m) ? alt_m_ : point.alt_m, x, y, z);
    if (std::isnan(point.alt_m)) z = point.alt_m;
    if (!std::isnan(point.horizontal_sd_m)) fix.horizontal_sd_m = point.horizontal_sd_m;
    if (!std::isnan(point.vertical_sd_m)) fix.vertical_sd_m = point.vertical_sd_m;
    fixes_.push_back(fix);
  }
}

std::array<double, 12> LocalAxes::to_utm(const std::array<double, 12>& pose) const {
  const GeographicLib::LocalCartesian local(lat_deg_, lon_deg_, alt_m_);
  double lat = 0, lon = 0, alt = 0, east = 0, north = 0, convergence_deg = 0, scale = 1;
  std::vector<double> here_to_local(9);
  local.Reverse(pose[3], pose[7], pose[11], lat, lon, alt, here_to_local);
  int zone = zone_;
  bool northern = north_;
  try {
    GeographicLib::UTMUPS::Forward(lat, lon, zone, northern, east, north, convergence_deg, scale, zone_);
  } catch (const GeographicLib::GeographicErr&) {
    fail("a pose lies at latitude ", lat, "°, longitude ", lon, "°, which is too far from UTM zone ", zone_);
  }
  if (northern != north_) north += north_ ? -GeographicLib::UTMUPS::UTMShift() : GeographicLib::UTMUPS::UTMShift();
  const double angle = to_radians(convergence_deg), c = std::cos(angle), s = std::sin(angle);
  std::array<double, 12> result{};
  for (std::size_t column = 0; column < 3; ++column) {
    std::array<double, 3> here{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) here[i] += here_to_local[3 * k + i] * pose[4 * k + column];
    }
    result[column] = c * here[0] - s * here[1];
    result[4 + column] = s * here[0] + c * here[1];
    result[8 + column] = here[2];
  }
  result[3] = east;
  result[7] = north;
  result[11] = alt;
  return result;
}

}  // namespace roadstereo::io
