#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "io/flight/outline_union.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/io/flight_frame.hpp"

namespace roadstereo::io {

/// What the sightings of a damage that the border cuts in all frames show together.
class CutExtent {
 public:
  /// Adds a sighting, whose outline in the world is `outline_m`; empty: unknown. Those whose depths differ from that of
  /// the best sighting are not of the same hollow and count no further.
  void add(const Damage& seen, bool is_best, const std::optional<FlightPose>& pose,
           const std::vector<std::array<double, 3>>& outline_m);

  /// Returns the measurement in one frame, extended to what all have shown.
  Damage extended(const Damage& measured) const;

 private:
  void cover(double area_m2, const FlightPose& pose, const std::vector<std::array<double, 3>>& outline_m);

  int piece_ = 0;                        ///< of the first sighting with an outline
  RigidTransform to_road_{};             ///< from the world of the piece to the road of that sighting
  std::optional<OutlineUnion> covered_;  ///< what the sightings cover there whose depths agree with the best one's
  std::optional<OutlineUnion> largest_;  ///< what the largest of these does
  double largest_m2_ = 0;                ///< its measured area
  Measurement depth_;                    ///< maximum depth of the best sighting
};

}  // namespace roadstereo::io
