#pragma once

#include <string>
#include <vector>

#include "flight/flight_job.hpp"
#include "flight/flight_settings.hpp"
#include "roadstereo/io/geo_files.hpp"
#include "roadstereo/io/track.hpp"

namespace roadstereo::cli {

/// Where the frames of a flight and its damages lie, by the track of a receiver.
class FlightPlaces {
 public:
  /// Reads the track. Throws Error naming its file and line.
  explicit FlightPlaces(const TrackSettings& settings);

  /// Takes the next frame. A time outside the track leaves it without a place.
  void add(const io::FlightFrame& frame);

  std::size_t placed() const { return placed_; }  ///< frames that have a place

  /// Why no frame has a place, with the times of both; nothing when one has.
  std::string why_nowhere() const;

  /// frames.geojson, damages.geojson and flight.gpkg.
  std::vector<StagedFile> files() const;

 private:
  double offset_s_;
  io::Track track_;
  std::vector<io::GeoFrame> frames_;
  std::vector<io::GeoDamage> damages_;
  std::size_t placed_ = 0;
};

}  // namespace roadstereo::cli
