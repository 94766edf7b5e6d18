#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "roadstereo/io/flight_frame.hpp"

namespace roadstereo::io {

/// One damage of the road, seen in one or several frames of a flight.
struct RoadDamage {
  std::int64_t id = 0;         ///< unique in the flight, from 1
  std::int64_t sightings = 0;  ///< number of frames that show it
  std::int64_t frame = 0;      ///< index of the best frame: not cut by the border if possible, then smallest error
  std::string frame_name;
  double time_s = FlightFrame::unknown;
  Damage best;  ///< the measurement in that frame
};

/// Returns whether `one` is more severe than `other`, or as severe and deeper.
bool is_worse(const RoadDamage& one, const RoadDamage& other);

/// Tracks damages over the frames of a flight. Sightings in successive frames are one damage if their boxes overlap
/// after the image motion is compensated. Tracking restarts at a frame whose road model was estimated anew; frames too
/// far apart to overlap yield one damage per sighting.
class FlightInventory {
 public:
  /// Adds the next frame of the flight. Returns the id of the road damage of each of its damages.
  std::vector<std::int64_t> add(const FlightFrame& frame);

  /// All damages of the road in the order of their first sighting.
  const std::vector<RoadDamage>& damages() const { return damages_; }

  /// At most `max_count` damages, worst first.
  std::vector<RoadDamage> worst(std::size_t max_count) const;

 private:
  /// Last sighting of a damage.
  struct Sighting {
    std::int64_t id = 0;
    std::int64_t sequence = 0;  ///< number of the frame in the flight
    Damage damage;
  };
  const Sighting* seen_before(const Damage& damage, const std::vector<std::int64_t>& taken) const;
  void remember(const std::vector<Sighting>& sightings);

  std::vector<RoadDamage> damages_;
  std::vector<Sighting> recent_;
  std::array<double, 2> motion_px_{};  ///< image motion from frame to frame
  std::int64_t sequence_ = 0;
};

}  // namespace roadstereo::io
