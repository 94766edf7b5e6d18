#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "roadstereo/io/flight_frame.hpp"

namespace roadstereo::io {

/// One damage of the road as a flight saw it, in one frame or in several.
struct RoadDamage {
  std::int64_t id = 0;         ///< over the whole flight, from 1
  std::int64_t sightings = 0;  ///< frames that saw it
  std::int64_t frame = 0;      ///< the frame that measured it best: whole if any did, then with the least error
  std::string frame_name;
  double time_s = FlightFrame::unknown;
  Damage best;  ///< as measured in that frame
};

/// Orders by severity, then by depth: the worst first.
bool is_worse(const RoadDamage& one, const RoadDamage& other);

/// The damages of a flight, frame by frame: sightings in successive frames whose outlines, moved as the picture moved,
/// lie over each other are one damage. A frame whose road was found anew does not follow from the one before, and
/// frames far apart do not overlap: then each sighting counts by itself.
class FlightInventory {
 public:
  /// Takes the damages of the next frame in order, and tells the road damage that each belongs to.
  std::vector<std::int64_t> add(const FlightFrame& frame);

  /// All of them, in the order in which they were first seen.
  const std::vector<RoadDamage>& damages() const { return damages_; }

  /// The worst ones, worst first, `most` of them.
  std::vector<RoadDamage> worst(std::size_t most) const;

 private:
  /// Where a damage was last seen.
  struct Sighting {
    std::int64_t id = 0;
    std::int64_t place = 0;  ///< which frame of the flight
    Damage damage;
  };
  const Sighting* seen_before(const Damage& damage, const std::vector<std::int64_t>& taken) const;
  void remember(const std::vector<Sighting>& sightings);

  std::vector<RoadDamage> damages_;
  std::vector<Sighting> recent_;
  std::array<double, 2> motion_px_{};  ///< of the picture from frame to frame
  std::int64_t place_ = 0;
};

}  // namespace roadstereo::io
