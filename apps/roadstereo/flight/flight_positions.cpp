#include "flight/flight_positions.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

}  // namespace

FlightPositions::FlightPositions(const TrackSettings& settings)
    : offset_s_(settings.offset_s), track_(io::read_track(settings.file, options_of(settings))) {}

void FlightPositions::add(const io::FlightFrame& frame) {
  io::GeoFrame geo;
  geo.index = frame.index;
  geo.name = frame.name;
  geo.time_s = frame.time_s + offset_s_;
  if (std::isfinite(geo.time_s)) geo.position = io::position_at(track_, geo.time_s);
  geo.roll_rad = frame.roll_rad;
  geo.height_m = frame.height_m;
  geo.sigma_d_px = frame.sigma_d_px;
  geo.valid_share = frame.valid_share;
  geo.damages = static_cast<int>(frame.damages.size());
  geo.status = name_of(frame.status);
  located_ += geo.position ? 1 : 0;
  for (const Damage& damage : frame.damages) {
    damages_.push_back({geo.index, geo.name, geo.time_s, damage, position_of(damage, geo.position, frame.height_m)});
  }
  frames_.push_back(std::move(geo));
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

std::vector<StagedFile> FlightPositions::files() const {
  return {text_file("frames.geojson", io::frames_geojson(frames_)),
          text_file("damages.geojson", io::damages_geojson(damages_)),
          {"flight.gpkg", io::geopackage(frames_, damages_, track_)}};
}

}  // namespace roadstereo::cli
