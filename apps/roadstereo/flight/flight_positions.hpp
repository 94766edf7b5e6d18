#pragma once

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

  /// Adds the next frame. It has no position if its time is outside the track.
  void add(const io::FlightFrame& frame);

  std::size_t located() const { return located_; }  ///< number of frames with a position

  /// Returns the reason if no frame has a position, with the times of frames and track, else "".
  std::string no_position_reason() const;

  /// Returns frames.geojson, damages.geojson and flight.gpkg.
  std::vector<StagedFile> files() const;

 private:
  double offset_s_;
  io::Track track_;
  std::vector<io::GeoFrame> frames_;
  std::vector<io::GeoDamage> damages_;
  std::size_t located_ = 0;
};

}  // namespace roadstereo::cli
