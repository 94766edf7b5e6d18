#include "flight/flight_positions.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/degrees.hpp"
#include "io/flight/standing.hpp"
#include "io/geo/travel_heading.hpp"

namespace roadstereo::cli {

namespace {

io::TrackOptions options_of(const TrackSettings& settings) {
  io::TrackOptions options;
  options.mount_yaw_deg = settings.mount_yaw_deg;
  return options;
}

/// Returns the position of a damage, or nullopt if the foot of the camera or the metric values are unknown.
std::optional<io::GeoPosition> position_of(const Damage& damage, const std::optional<io::GeoPosition>& foot) {
  if (!foot || !damage.metrics) return std::nullopt;
  const auto& [right_m, forward_m] = damage.metrics->road_centroid_m;
  constexpr double on_road_m = 0;
  return io::offset_position(*foot, right_m, forward_m, on_road_m);
}

/// Returns longitudes and latitudes of a polygon on the road; empty if the heading is unknown.
std::vector<std::array<double, 2>> on_earth(const std::vector<std::array<double, 2>>& corners_m,
                                            const std::optional<io::GeoPosition>& foot) {
  std::vector<std::array<double, 2>> corners_deg;
  if (!foot) return corners_deg;
  for (const auto& [right_m, forward_m] : corners_m) {
    const std::optional<io::GeoPosition> corner = io::offset_position(*foot, right_m, forward_m);
    if (!corner) return {};
    corners_deg.push_back({corner->lon_deg, corner->lat_deg});
  }
  return corners_deg;
}

}  // namespace

FlightPositions::FlightPositions(const TrackSettings& settings)
    : offset_s_(settings.offset_s),
      mount_yaw_deg_(settings.mount_yaw_deg),
      track_(io::read_track(settings.file, options_of(settings))) {}

void FlightPositions::add(const io::FlightFrame& frame, const std::vector<std::int64_t>& road_damages) {
  io::GeoFrame geo;
  geo.index = frame.index;
  geo.name = frame.name;
  geo.time_s = frame.time_s + offset_s_;
  geo.roll_rad = frame.roll_rad;
  geo.height_m = frame.height_m;
  geo.sigma_d_px = frame.sigma_d_px;
  geo.valid_share = frame.valid_share;
  if (std::isfinite(frame.noise_px)) geo.damages = static_cast<std::int64_t>(frame.damages.size());
  geo.status = name_of(frame.status);
  for (std::size_t i = 0; i < frame.damages.size(); ++i) {
    sightings_.push_back({road_damages[i], geo.index, geo.name, geo.time_s, frame.damages[i], {}});
  }
  frames_.push_back(std::move(geo));
  Ground ground;
  ground.footprint_m = frame.footprint_m;
  ground.has_moved = has_moved(frame);
  grounds_.push_back(std::move(ground));
}

void FlightPositions::place(std::span<const CameraPlace> places) {
  for (std::size_t i = 0; i < frames_.size(); ++i) place_by_track(i);
  place_by_trajectory(places);
  set_stations(!places.empty());
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    frames_[i].footprint_deg = on_earth(grounds_[i].footprint_m, grounds_[i].foot);
  }
  for (io::GeoSighting& sighting : sightings_) {
    sighting.position = position_of(sighting.damage, grounds_[at_or_after(sighting.frame)].foot);
  }
}

void FlightPositions::place_by_track(std::size_t i) {
  io::GeoFrame& frame = frames_[i];
  if (!std::isfinite(frame.time_s)) return;
  frame.position = io::position_at(track_, frame.time_s);
  if (!frame.position) return;
  grounds_[i].foot = frame.position;
  grounds_[i].foot->alt_m -= frame.height_m;
  grounds_[i].view_yaw_deg = mount_yaw_deg_;
}

/// The travel is along the path, wherever the camera looks; a camera that has not moved looks as the track says.
void FlightPositions::place_by_trajectory(std::span<const CameraPlace> places) {
  std::vector<io::TrackPoint> path;
  for (const CameraPlace& place : places) {
    const std::size_t i = at_or_after(place.frame);
    frames_[i].position = place.camera;
    grounds_[i].foot = place.foot;
    grounds_[i].by_trajectory = true;
    path.push_back({frames_[i].time_s, place.camera.lat_deg, place.camera.lon_deg});
  }
  io::fill_headings(path, track_.options());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double yaw_deg = places[k].camera.heading_deg - path[k].heading_deg;
    grounds_[at_or_after(places[k].frame)].view_yaw_deg = std::isfinite(yaw_deg) ? yaw_deg : mount_yaw_deg_;
  }
}

/// Distances along the path. Steps are taken from the last position that is well away, so that the noise of the
/// positions does not add up while the camera stands and nobody knows it, and not between trajectory and track.
void FlightPositions::set_stations(bool by_trajectory) {
  constexpr double min_step_m = 0.5;
  std::optional<io::GeoPosition> last;
  double last_station_m = 0, station_m = 0;
  located_ = 0;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    io::GeoFrame& frame = frames_[i];
    if (!frame.position) continue;
    ++located_;
    if (grounds_[i].has_moved && grounds_[i].by_trajectory == by_trajectory) {
      const double step_m = last ? io::distance_m(*last, *frame.position) : 0;
      station_m = std::max(station_m, last_station_m + step_m);
      if (!last || step_m >= min_step_m) {
        last = frame.position;
        last_station_m += step_m;
      }
    }
    frame.station_m = station_m;
  }
}

/// Distance of a damage from the camera along the travel, which the camera need not look along; 0 if unknown.
double FlightPositions::distance_ahead_m(std::size_t i, const Damage& damage) const {
  if (!damage.metrics) return 0;
  const auto& [right_m, forward_m] = damage.metrics->road_centroid_m;
  const double yaw_rad = to_radians(grounds_[i].view_yaw_deg);
  return forward_m * std::cos(yaw_rad) - right_m * std::sin(yaw_rad);
}

/// The same of a place on the Earth, from a frame with a position.
double FlightPositions::distance_ahead_m(std::size_t i, const io::GeoPosition& place) const {
  const io::GeoPosition& camera = *frames_[i].position;
  if (!std::isfinite(camera.heading_deg)) return 0;
  const double east_deg = std::remainder(place.lon_deg - camera.lon_deg, 360.0);
  const double north_m =
      std::copysign(io::distance_m(camera, {place.lat_deg, camera.lon_deg}), place.lat_deg - camera.lat_deg);
  const double east_m = std::copysign(io::distance_m(camera, {camera.lat_deg, place.lon_deg}), east_deg);
  const double travel_rad = to_radians(camera.heading_deg - grounds_[i].view_yaw_deg);
  return north_m * std::cos(travel_rad) + east_m * std::sin(travel_rad);
}

/// Frame with a position that is nearest to a place when the camera first passes it: from a frame that shows it until
/// the camera goes away, since it may come back.
std::optional<std::size_t> FlightPositions::first_pass(std::int64_t first_frame, const io::GeoPosition& place) const {
  constexpr double min_step_m = 0.5;
  std::optional<std::size_t> nearest;
  double min_distance_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = at_or_after(first_frame); i < frames_.size(); ++i) {
    if (!frames_[i].position) continue;
    const double away_m = io::distance_m(*frames_[i].position, place);
    if (away_m > min_distance_m + min_step_m) break;
    if (away_m >= min_distance_m) continue;
    min_distance_m = away_m;
    nearest = i;
  }
  return nearest;
}

/// First frame of at least that index.
std::size_t FlightPositions::at_or_after(std::int64_t index) const {
  const auto frame = std::lower_bound(frames_.begin(), frames_.end(), index,
                                      [](const io::GeoFrame& one, std::int64_t of) { return one.index < of; });
  return static_cast<std::size_t>(frame - frames_.begin());
}

bool FlightPositions::has_moved(const io::FlightFrame& frame) {
  const bool stands = io::stands_at(view_from_, frame);
  if (!stands && frame.pose) view_from_ = frame.pose;
  return !stands;
}

void FlightPositions::locate(io::RoadDamage& damage) const {
  const std::size_t i = at_or_after(damage.frame);
  if (i == frames_.size() || frames_[i].index != damage.frame) return;
  damage.time_s = frames_[i].time_s;
  if (!frames_[i].position) return;
  damage.ahead_m = distance_ahead_m(i, damage.best);
  damage.station_m = frames_[i].station_m + damage.ahead_m;
  damage.position = position_of(damage.best, grounds_[i].foot);
  if (damage.position) {
    const std::optional<std::size_t> passing = first_pass(damage.first_frame, *damage.position);
    if (passing && *passing != i) {
      damage.station_m = frames_[*passing].station_m + distance_ahead_m(*passing, *damage.position);
    }
  }
  if (damage.best.metrics) damage.outline_deg = on_earth(damage.best.metrics->outline_m, grounds_[i].foot);
}

std::string FlightPositions::no_position_reason() const {
  if (located_ > 0 || frames_.empty()) return {};
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  for (const io::GeoFrame& frame : frames_) {
    if (!std::isfinite(frame.time_s)) continue;
    first = std::min(first, frame.time_s);
    last = std::max(last, frame.time_s);
  }
  if (first > last) return "the frames have no times; set --rate and --track-offset";
  if (std::string gaps = gaps_text(); !gaps.empty()) return gaps;
  return fmt::format(
      "the times of the frames are {:.3f} … {:.3f} s, those of the track {:.3f} … {:.3f} s; see --track-offset", first,
      last, track_.points().front().time_s, track_.points().back().time_s);
}

/// Time between the fixes around a time; 0 outside of the track and where they are near enough.
double FlightPositions::gap_s(double time_s) const {
  const std::vector<io::TrackPoint>& points = track_.points();
  if (!(time_s > points.front().time_s && time_s < points.back().time_s)) return 0;
  const auto after = std::lower_bound(points.begin(), points.end(), time_s,
                                      [](const io::TrackPoint& point, double time) { return point.time_s < time; });
  const double apart_s = after->time_s - std::prev(after)->time_s;
  return apart_s > track_.options().max_gap_s ? apart_s : 0;
}

std::string FlightPositions::gaps_text() const {
  std::size_t without = 0;
  double longest_s = 0;
  for (const io::GeoFrame& frame : frames_) {
    const double apart_s = frame.position ? 0 : gap_s(frame.time_s);
    if (apart_s == 0) continue;
    ++without;
    longest_s = std::max(longest_s, apart_s);
  }
  if (without == 0) return {};
  return fmt::format("{} of {} frames lie between fixes that are too far apart, up to {:.0f} s (limit {} s)", without,
                     frames_.size(), longest_s, track_.options().max_gap_s);
}

std::string FlightPositions::outliers_text() const {
  const std::vector<io::TrackPoint>& outliers = track_.outliers();
  if (outliers.empty()) return {};
  return fmt::format(
      "{} of the {} fixes of the track rejected: faster than 100 m/s from their neighbours (the first at {:.3f} s)",
      outliers.size(), outliers.size() + track_.points().size(), outliers.front().time_s);
}

std::vector<StagedFile> FlightPositions::files(std::span<const io::RoadDamage> damages, bool with_candidates) const {
  std::vector<io::GeoSighting> sightings = sightings_;
  std::erase_if(sightings, [&](const io::GeoSighting& sighting) {
    return !with_candidates && damages[static_cast<std::size_t>(sighting.road_damage) - 1].candidate;
  });
  const io::GeoLayers layers{frames_, sightings, damages, with_candidates};
  std::vector<StagedFile> files{{"flight.gpkg", io::geopackage(layers, track_)}};
  for (const io::NamedText& file : io::geojson_files(layers)) files.push_back(text_file(file.name, file.text));
  return files;
}

}  // namespace roadstereo::cli
