#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flight/camera_place.hpp"
#include "flight/flight_job.hpp"
#include "flight/flight_settings.hpp"
#include "roadstereo/io/geo_files.hpp"
#include "roadstereo/io/track.hpp"

namespace roadstereo::cli {

/// Positions of the frames and damages of a flight: from its trajectory on the Earth, or from a GNSS track alone.
class FlightPositions {
 public:
  /// Reads the track. Throws Error naming its file and line.
  explicit FlightPositions(const TrackSettings& settings);

  /// Adds the next frame, whose damages are those of the road with these ids.
  void add(const io::FlightFrame& frame, const std::vector<std::int64_t>& road_damages);

  /// Gives positions and stations to the frames that were added, and to their damages: by the trajectory (its places
  /// in order), a frame that it does not place by the track, with the heading of the track. A frame that neither
  /// places has no position.
  void place(std::span<const CameraPlace> places);

  std::size_t located() const { return located_; }  ///< number of frames with a position

  /// Returns the reason if no frame has a position, with the times of frames and track, else "".
  std::string no_position_reason() const;

  /// Returns how many frames have no position since the fixes around them are too far apart in time, and how far; "" if
  /// there is none.
  std::string gaps_text() const;

  /// Returns how many fixes of the track were left out as outliers, and the first one's time; "" if none was.
  std::string outliers_text() const;

  /// Sets position and outline of a damage from its best frame, if that has a position, and the station where the
  /// camera first passed that position.
  void locate(io::RoadDamage& damage) const;

  const std::vector<io::GeoFrame>& frames() const { return frames_; }

  /// Returns the GeoJSON files and flight.gpkg.
  std::vector<StagedFile> files(std::span<const io::RoadDamage> damages, bool with_candidates) const;

 private:
  /// What else is known of a frame.
  struct Ground {
    std::vector<std::array<double, 2>> footprint_m;
    bool has_moved = true;                ///< since the frame before, by the poses; true without them
    std::optional<io::GeoPosition> foot;  ///< of the camera on the road
    double view_yaw_deg = 0;              ///< of the camera relative to the travel, clockwise
    bool by_trajectory = false;           ///< placed by it
  };

  bool has_moved(const io::FlightFrame& frame);
  void place_by_track(std::size_t i);
  void place_by_trajectory(std::span<const CameraPlace> places);
  void set_stations(bool by_trajectory);
  double distance_ahead_m(std::size_t i, const Damage& damage) const;
  double distance_ahead_m(std::size_t i, const io::GeoPosition& place) const;
  std::size_t at_or_after(std::int64_t index) const;
  double gap_s(double time_s) const;
  std::optional<std::size_t> first_pass(std::int64_t first_frame, const io::GeoPosition& place) const;

  double offset_s_;
  double mount_yaw_deg_;
  io::Track track_;
  std::vector<io::GeoFrame> frames_;
  std::vector<Ground> grounds_;  ///< of each frame
  std::vector<io::GeoSighting> sightings_;
  std::size_t located_ = 0;
  std::optional<io::FlightPose> view_from_;  ///< first pose at the place where the camera is
};

}  // namespace roadstereo::cli
