#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/io/flight_inventory.hpp"
#include "roadstereo/io/flight_report.hpp"

namespace roadstereo::cli {

/// What the frames of a flight add up to.
struct FlightSummary {
  std::int64_t frames = 0;
  std::int64_t good = 0;
  std::int64_t refused = 0;
  std::int64_t failed = 0;
  std::int64_t road_estimated = 0;     ///< frames whose road was estimated anew
  std::int64_t road_unknown = 0;       ///< ... or not found before matching
  std::optional<std::int64_t> placed;  ///< frames that the track has a place for; absent without a track
  std::string track_note;              ///< why no frame has a place, when none has
  std::int64_t damages = 0;            ///< of the road (FlightInventory)
  std::int64_t sightings = 0;          ///< of damages, over all frames
  std::vector<std::string> reasons;    ///< why frames are not good, each once, the first few
  double first_time_s = io::FlightFrame::unknown;
  double last_time_s = io::FlightFrame::unknown;
  io::FlightCurves curves;  ///< of every frame
  std::vector<double> valid_share;
  std::vector<double> matching_ms;
  std::vector<double> damage_ms;

  void add(const io::FlightFrame& frame);

  /// Turns the curves' times into seconds since the first frame, where all frames have one; else numbers of frames.
  void settle_times();
};

}  // namespace roadstereo::cli
