#include "roadstereo/io/track.hpp"

#include <GeographicLib/Geodesic.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/degrees.hpp"
#include "io/geo/track_outliers.hpp"
#include "io/geo/travel_heading.hpp"
#include "io/geo/utc_time.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Normalises an angle to 0 ≤ angle < 360.
double on_compass(double angle_deg) {
  const double turned = std::fmod(angle_deg, 360.0);
  const double positive = turned < 0 ? turned + 360 : turned;
  return positive >= 360 ? 0 : positive;  // a tiny negative angle rounds up to 360; NaN is kept
}

void check_point(const TrackPoint& point, std::size_t index) {
  const auto require = [index](const char* name, double value, double lowest, double highest) {
    if (value >= lowest && value <= highest) return;
    fail("point ", index, " of the track: ", name, " is ", value, "; it must be between ", lowest, " and ", highest);
  };
  require("time_s", point.time_s, 0, latest_unix_s);
  require("lat_deg", point.lat_deg, -90, 90);
  require("lon_deg", point.lon_deg, -180, 180);
  if (!std::isnan(point.heading_deg)) require("heading_deg", point.heading_deg, -360, 360);
  if (std::isinf(point.alt_m)) fail("point ", index, " of the track: alt_m is infinite; it must be a number or NaN");
  const auto require_error = [index](const char* name, double value) {
    if (std::isnan(value) || (value > 0 && std::isfinite(value))) return;
    fail("point ", index, " of the track: ", name, " is ", value, "; it must be above 0 and finite, or NaN");
  };
  require_error("horizontal_sd_m", point.horizontal_sd_m);
  require_error("vertical_sd_m", point.vertical_sd_m);
}

void check_points(const std::vector<TrackPoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    check_point(points[i], i);
    if (i > 0 && points[i].time_s < points[i - 1].time_s) {
      fail("point ", i, " of the track is ", points[i - 1].time_s - points[i].time_s,
           " s before its predecessor; times must increase");
    }
  }
}

double between(double from, double to, double share) {
  return from + share * (to - from);
}

double between_headings(double from_deg, double to_deg, double share) {
  return from_deg + share * std::remainder(to_deg - from_deg, 360.0);
}

GeoPosition position_of(const TrackPoint& point, double mount_yaw_deg) {
  return {point.lat_deg, point.lon_deg, point.alt_m, on_compass(point.heading_deg + mount_yaw_deg)};
}

TrackPoint point_between(const TrackPoint& from, const TrackPoint& to, double time_s) {
  const GeographicLib::Geodesic& earth = GeographicLib::Geodesic::WGS84();
  const double share = (time_s - from.time_s) / (to.time_s - from.time_s);
  double way_m = 0;
  double from_deg = 0;
  double to_deg = 0;
  earth.Inverse(from.lat_deg, from.lon_deg, to.lat_deg, to.lon_deg, way_m, from_deg, to_deg);
  TrackPoint point;
  point.time_s = time_s;
  earth.Direct(from.lat_deg, from.lon_deg, from_deg, share * way_m, point.lat_deg, point.lon_deg);
  point.alt_m = between(from.alt_m, to.alt_m, share);
  point.heading_deg = between_headings(from.heading_deg, to.heading_deg, share);
  return point;
}

}  // namespace

Track::Track(std::vector<TrackPoint> points, const TrackOptions& options)
    : points_(std::move(points)), options_(options) {
  options_.validate();
  check_points(points_);
  const auto same_time = [](const TrackPoint& one, const TrackPoint& other) { return one.time_s == other.time_s; };
  points_.erase(std::unique(points_.begin(), points_.end(), same_time), points_.end());
  if (points_.size() < 2)
    fail("the track has ", points_.size(), " point(s); it must have at least two at different times");
  outliers_ = take_outliers(points_, options_);
  fill_headings(points_, options_);
}

std::optional<GeoPosition> position_at(const Track& track, double time_s) {
  const std::vector<TrackPoint>& points = track.points();
  const TrackOptions& options = track.options();
  if (!(time_s >= points.front().time_s && time_s <= points.back().time_s)) return std::nullopt;
  const auto after = std::lower_bound(points.begin(), points.end(), time_s,
                                      [](const TrackPoint& point, double time) { return point.time_s < time; });
  if (after->time_s == time_s) return position_of(*after, options.mount_yaw_deg);
  const auto before = std::prev(after);
  if (after->time_s - before->time_s > options.max_gap_s || !is_reachable(*before, *after)) return std::nullopt;
  return position_of(point_between(*before, *after, time_s), options.mount_yaw_deg);
}

std::optional<GeoPosition> offset_position(const GeoPosition& from, double right_m, double forward_m, double up_m) {
  if (!std::isfinite(from.heading_deg + right_m + forward_m)) return std::nullopt;
  const double bearing_deg = from.heading_deg + to_degrees(std::atan2(right_m, forward_m));
  GeoPosition to = from;
  GeographicLib::Geodesic::WGS84().Direct(from.lat_deg, from.lon_deg, bearing_deg, std::hypot(right_m, forward_m),
                                          to.lat_deg, to.lon_deg);
  to.alt_m = from.alt_m + up_m;
  return to;
}

double distance_m(const GeoPosition& from, const GeoPosition& to) {
  double way_m = 0;
  GeographicLib::Geodesic::WGS84().Inverse(from.lat_deg, from.lon_deg, to.lat_deg, to.lon_deg, way_m);
  return way_m;
}

}  // namespace roadstereo::io
