#include "roadstereo/io/local_axes.hpp"

#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <algorithm>
#include <cmath>

#include "core/degrees.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// A pose on the ellipsoid: axes of the camera east, north and up at its own place.
struct EarthPose {
  double lat_deg = 0, lon_deg = 0, alt_m = 0;
  std::array<std::array<double, 3>, 3> axes{};  ///< x, y and z of the camera
};

EarthPose on_earth(const GeographicLib::LocalCartesian& local, const std::array<double, 12>& pose) {
  EarthPose result;
  std::vector<double> here_to_local(9);
  local.Reverse(pose[3], pose[7], pose[11], result.lat_deg, result.lon_deg, result.alt_m, here_to_local);
  for (std::size_t column = 0; column < 3; ++column) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        result.axes[column][i] += here_to_local[3 * k + i] * pose[4 * k + column];
      }
    }
  }
  return result;
}

/// The middle one of the fixes within a time, of all if none is.
const TrackPoint& middle_fix(const std::vector<TrackPoint>& points, double from_s, double to_s) {
  auto first = std::lower_bound(points.begin(), points.end(), from_s,
                                [](const TrackPoint& point, double time_s) { return point.time_s < time_s; });
  auto end = std::upper_bound(points.begin(), points.end(), to_s,
                              [](double time_s, const TrackPoint& point) { return time_s < point.time_s; });
  if (first >= end) first = points.begin(), end = points.end();
  return *(first + (end - first - 1) / 2);
}

}  // namespace

LocalAxes::LocalAxes(const Track& track, double from_s, double to_s) {
  const TrackPoint& origin = middle_fix(track.points(), from_s, to_s);
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
  const EarthPose here = on_earth({lat_deg_, lon_deg_, alt_m_}, pose);
  double east = 0, north = 0, convergence_deg = 0, scale = 1;
  int zone = zone_;
  bool northern = north_;
  try {
    GeographicLib::UTMUPS::Forward(here.lat_deg, here.lon_deg, zone, northern, east, north, convergence_deg, scale,
                                   zone_);
  } catch (const GeographicLib::GeographicErr&) {
    fail("a pose lies at latitude ", here.lat_deg, "°, longitude ", here.lon_deg, "°, which is too far from UTM zone ",
         zone_);
  }
  if (northern != north_) north += north_ ? -GeographicLib::UTMUPS::UTMShift() : GeographicLib::UTMUPS::UTMShift();
  const double angle = to_radians(convergence_deg), c = std::cos(angle), s = std::sin(angle);
  std::array<double, 12> result{};
  for (std::size_t column = 0; column < 3; ++column) {
    const auto& [to_east, to_north, up] = here.axes[column];
    result[column] = c * to_east - s * to_north;
    result[4 + column] = s * to_east + c * to_north;
    result[8 + column] = up;
  }
  result[3] = east;
  result[7] = north;
  result[11] = here.alt_m;
  return result;
}

GeoPosition LocalAxes::position(const std::array<double, 12>& pose) const {
  const EarthPose here = on_earth({lat_deg_, lon_deg_, alt_m_}, pose);
  GeoPosition position{here.lat_deg, here.lon_deg, here.alt_m};
  const auto& [right_east, right_north, right_up] = here.axes[0];
  if (right_east != 0 || right_north != 0) {
    constexpr double turn_deg = 360;
    position.heading_deg = std::fmod(to_degrees(std::atan2(-right_north, right_east)) + turn_deg, turn_deg);
  }
  return position;
}

}  // namespace roadstereo::io
