#include "flight/flight_positions.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/degrees.hpp"
#include "io/flight/standing.hpp"

namespace roadstereo::cli {

namespace {

io::TrackOptions options_of(const TrackSettings& settings) {
  io::TrackOptions options;
  options.mount_yaw_deg = settings.mount_yaw_deg;
  return options;
}

/// Returns the position of a damage, or nullopt if the camera position or the metric values are unknown.
std::optional<io::GeoPosition> position_of(const Damage& damage, const std::optional<io::GeoPosition>& camera,
                                           double height_m) {
  if (!camera || !damage.metrics) return std::nullopt;
  const auto& [right_m, forward_m] = damage.metrics->road_centroid_m;
  return io::offset_position(*camera, right_m, forward_m, -height_m);
}

/// Returns longitudes and latitudes of a polygon on the road; empty if the heading is unknown.
std::vector<std::array<double, 2>> on_earth(const std::vector<std::array<double, 2>>& corners_m,
                                            const std::optional<io::GeoPosition>& camera) {
  std::vector<std::array<double, 2>> corners_deg;
  if (!camera) return corners_deg;
  for (const auto& [right_m, forward_m] : corners_m) {
    const std::optional<io::GeoPosition> corner = io::offset_position(*camera, right_m, forward_m);
    if (!corner) return {};
    corners_deg.push_back({corner->lon_deg, corner->lat_deg});
  }
  return corners_deg;
}

}  // namespace

FlightPositions::FlightPositions(const TrackSettings& settings)
    : offset_s_(settings.offset_s),
      mount_yaw_rad_(to_radians(settings.mount_yaw_deg)),
      track_(io::read_track(settings.file, options_of(settings))) {}

void FlightPositions::add(const io::FlightFrame& frame, const std::vector<std::int64_t>& road_damages) {
  io::GeoFrame geo;
  geo.index = frame.index;
  geo.name = frame.name;
  geo.time_s = frame.time_s + offset_s_;
  if (std::isfinite(geo.time_s)) geo.position = io::position_at(track_, geo.time_s);
  if (geo.position) {
    if (has_moved(frame)) update_station(*geo.position);
    geo.station_m = station_m_;
    ++located_;
  }
  geo.footprint_deg = on_earth(frame.footprint_m, geo.position);
  geo.roll_rad = frame.roll_rad;
  geo.height_m = frame.height_m;
  geo.sigma_d_px = frame.sigma_d_px;
  geo.valid_share = frame.valid_share;
  if (std::isfinite(frame.noise_px)) geo.damages = static_cast<std::int64_t>(frame.damages.size());
  geo.status = name_of(frame.status);
  for (std::size_t i = 0; i < frame.damages.size(); ++i) {
    sightings_.push_back({road_damages[i], geo.index, geo.name, geo.time_s, frame.damages[i],
                          position_of(frame.damages[i], geo.position, frame.height_m)});
  }
  frames_.push_back(std::move(geo));
}

/// Distance of a damage from the camera along the travel, which the camera need not look along; 0 if unknown.
double FlightPositions::distance_ahead_m(const Damage& damage) const {
  if (!damage.metrics) return 0;
  const auto& [right_m, forward_m] = damage.metrics->road_centroid_m;
  return forward_m * std::cos(mount_yaw_rad_) - right_m * std::sin(mount_yaw_rad_);
}

/// The same of a place on the Earth, from a frame with a position.
double FlightPositions::distance_ahead_m(const io::GeoFrame& frame, const io::GeoPosition& place) const {
  const io::GeoPosition& camera = *frame.position;
  if (!std::isfinite(camera.heading_deg)) return 0;
  const double east_deg = std::remainder(place.lon_deg - camera.lon_deg, 360.0);
  const double north_m =
      std::copysign(io::distance_m(camera, {place.lat_deg, camera.lon_deg}), place.lat_deg - camera.lat_deg);
  const double east_m = std::copysign(io::distance_m(camera, {camera.lat_deg, place.lon_deg}), east_deg);
  const double travel_rad = to_radians(camera.heading_deg) - mount_yaw_rad_;
  return north_m * std::cos(travel_rad) + east_m * std::sin(travel_rad);
}

/// Frame with a position that is nearest to a place when the camera first passes it: from a frame that shows it until
/// the camera goes away, since it may come back.
const io::GeoFrame* FlightPositions::first_pass(std::int64_t first_frame, const io::GeoPosition& place) const {
  constexpr double min_step_m = 0.5;
  const io::GeoFrame* nearest = nullptr;
  double min_distance_m = std::numeric_limits<double>::infinity();
  for (auto frame = at_or_after(first_frame); frame != frames_.end(); ++frame) {
    if (!frame->position) continue;
    const double away_m = io::distance_m(*frame->position, place);
    if (away_m > min_distance_m + min_step_m) break;
    if (away_m >= min_distance_m) continue;
    min_distance_m = away_m;
    nearest = &*frame;
  }
  return nearest;
}

/// First frame of at least that index.
std::vector<io::GeoFrame>::const_iterator FlightPositions::at_or_after(std::int64_t index) const {
  return std::lower_bound(frames_.begin(), frames_.end(), index,
                          [](const io::GeoFrame& one, std::int64_t of) { return one.index < of; });
}

/// Whether the camera has left the place of an earlier frame, by the poses; true without them.
bool FlightPositions::has_moved(const io::FlightFrame& frame) {
  const bool stands = io::stands_at(view_from_, frame);
  if (!stands && frame.pose) view_from_ = frame.pose;
  return !stands;
}

/// Distance along the track. Steps are taken from the last position that is well away, so that the noise of the
/// positions does not add up while the camera stands and nobody knows it.
void FlightPositions::update_station(const io::GeoPosition& position) {
  constexpr double min_step_m = 0.5;
  const double step_m = last_ ? io::distance_m(*last_, position) : min_step_m;
  const double station_m = last_ ? last_station_m_ + step_m : 0;
  if (step_m >= min_step_m) {
    last_ = position;
    last_station_m_ = station_m;
  }
  station_m_ = std::max(station_m_, station_m);
}

void FlightPositions::locate(io::RoadDamage& damage) const {
  const auto frame = at_or_after(damage.frame);
  if (frame == frames_.end() || frame->index != damage.frame) return;
  damage.time_s = frame->time_s;
  if (!frame->position) return;
  damage.ahead_m = distance_ahead_m(damage.best);
  damage.station_m = frame->station_m + damage.ahead_m;
  damage.position = position_of(damage.best, frame->position, frame->height_m);
  if (damage.position) {
    const io::GeoFrame* const passing = first_pass(damage.first_frame, *damage.position);
    if (passing != nullptr && passing->index != damage.frame) {
      damage.station_m = passing->station_m + distance_ahead_m(*passing, *damage.position);
    }
  }
  if (!damage.best.metrics) return;
  damage.outline_deg = on_earth(damage.best.metrics->outline_m, frame->position);
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
  return fmt::format(
      "the times of the frames are {:.3f} … {:.3f} s, those of the track {:.3f} … {:.3f} s; see --track-offset", first,
      last, track_.points().front().time_s, track_.points().back().time_s);
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
