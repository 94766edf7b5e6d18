#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "live/clock.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo::cli {

/// One processed pair, as far as it is shown.
struct LiveView {
  std::int64_t number = 0;               ///< of the view, from 1; set when it is published
  std::string name;                      ///< the source's
  Clock::time_point arrival{};           ///< when the pair came from its source
  double clock_s = 0;                    ///< the same by the calendar, seconds since 1970
  double latency_ms = 0;                 ///< from arrival to publication
  Frame left;                            ///< rectified
  Image<float> transformed;              ///< ℓ', pixels
  double delta_t = 0;                    ///< δt, pixels
  Image<std::uint16_t> ids;              ///< of the damage at each pixel, 0 none
  std::vector<Damage> damages;           ///< deepest first
  std::optional<RollEstimate> geometry;  ///< absent when no road was found
  std::optional<GroundPlane> plane;      ///< absent without a road or a calibration
  std::vector<std::string> warnings;
};

using SharedView = std::shared_ptr<const LiveView>;

}  // namespace roadstereo::cli
