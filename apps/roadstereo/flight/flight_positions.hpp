#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flight/flight_job.hpp"
#include "flight/flight_settings.hpp"
#include "roadstereo/io/geo_files.hpp"
#include "roadstereo/io/track.hpp"

namespace roadstereo::cli {

/// Positions of the frames and damages of a flight from a GNSS track.
class FlightPositions {
 public:
  /// Reads the track. Throws Error naming its file and line.
  explicit FlightPositions(const TrackSettings& settings);

  /// Adds the next frame, whose damages are those of the road with these ids. It has no position if its time is outside
  /// the track.
  void add(const io::FlightFrame& frame, const std::vector<std::int64_t>& road_damages);

  std::size_t located() const { return located_; }  ///< number of frames with a position

  /// Returns the reason if no frame has a position, with the times of frames and track, else "".
  std::string no_position_reason() const;

  /// Returns how many fixes of the track were left out as outliers, and the first one's time; "" if none was.
  std::string outliers_text() const;

  /// Sets position and outline of a damage from its best frame, if that has a position, and the station where the
  /// camera first passed that position.
  void locate(io::RoadDamage& damage) const;

  const std::vector<io::GeoFrame>& frames() const { return frames_; }

  /// Returns the GeoJSON files and flight.gpkg.
  std::vector<StagedFile> files(std::span<const io::RoadDamage> damages, bool with_candidates) const;

 private:
  bool has_moved(const io::FlightFrame& frame);
  void update_station(const io::GeoPosition& position);
  double distance_ahead_m(const Damage& damage) const;
  double distance_ahead_m(const io::GeoFrame& frame, const io::GeoPosition& place) const;
  std::vector<io::GeoFrame>::const_iterator at_or_after(std::int64_t index) const;
  const io::GeoFrame* first_pass(std::int64_t first_frame, const io::GeoPosition& place) const;

  double offset_s_;
  double mount_yaw_rad_;
  io::Track track_;
  std::vector<io::GeoFrame> frames_;
  std::vector<io::GeoSighting> sightings_;
  std::size_t located_ = 0;
  double station_m_ = 0;                     ///< of the last frame with a position
  std::optional<io::GeoPosition> last_;      ///< position that steps are taken from
  double last_station_m_ = 0;                ///< its station
  std::optional<io::FlightPose> view_from_;  ///< first pose at the place where the camera is
};

}  // namespace roadstereo::cli
