#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "live/clock.hpp"
#include "roadstereo/damage.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/health.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/roll.hpp"

namespace roadstereo::cli {

/// Displayed results of one pair.
struct LiveView {
  std::int64_t number = 0;               ///< from 1; set on publication
  std::string name;                      ///< in the source
  Clock::time_point arrival{};           ///< of the pair from the source
  double clock_s = 0;                    ///< the same as system time, seconds since 1970
  double latency_ms = 0;                 ///< from arrival to publication
  Frame left;                            ///< rectified
  double white_level = 0;                ///< of the left image, as in to_grey
  Image<float> transformed;              ///< ℓ', pixels
  double delta_t = 0;                    ///< δt, pixels
  Image<std::uint16_t> ids;              ///< of the damage at each pixel, 0: none
  std::vector<Damage> damages;           ///< deepest first
  std::optional<RollEstimate> geometry;  ///< absent if no road was found
  std::optional<GroundPlane> plane;      ///< absent without a road or a calibration
  PairHealth health;
  std::vector<std::string> warnings;
};

using SharedView = std::shared_ptr<const LiveView>;

}  // namespace roadstereo::cli
