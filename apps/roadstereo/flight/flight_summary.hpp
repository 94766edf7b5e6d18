#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flight/flight_health.hpp"
#include "inspection_limits.hpp"
#include "roadstereo/io/flight_inventory.hpp"
#include "roadstereo/io/flight_report.hpp"
#include "roadstereo/rig_bias.hpp"

namespace roadstereo::cli {

/// Statistics of the frames of a flight.
struct FlightSummary {
  std::int64_t frames = 0;
  std::int64_t good = 0;
  std::int64_t rejected = 0;
  std::int64_t failed = 0;
  std::int64_t road_estimated = 0;         ///< frames whose road model was estimated, not tracked
  std::int64_t road_unknown = 0;           ///< good frames without a road model before matching
  std::int64_t inspected = 0;              ///< frames in which damage was searched for
  std::int64_t untrusted = 0;              ///< of these, those whose depths cannot be trusted
  std::optional<std::int64_t> located;     ///< frames with a position; absent without a track
  std::int64_t located_by_trajectory = 0;  ///< of these, those placed by the trajectory instead of the track
  std::string no_position_reason;          ///< reason if no frame has a position
  std::string track_gaps;                  ///< which frames have no position since fixes lack, if others have one
  std::string track_outliers;              ///< which fixes of the track were left out
  std::int64_t damages = 0;                ///< road damages (FlightInventory)
  std::int64_t candidates = 0;             ///< of the road
  std::int64_t sightings = 0;              ///< damages of all frames
  std::vector<std::string> reasons;        ///< why frames are not good; of the first few
  double first_time_s = io::FlightFrame::unknown;
  double last_time_s = io::FlightFrame::unknown;
  io::StaticMaskRecord static_mask;  ///< of the last frame
  FlightHealth health;
  RigBias rig_bias;               ///< of all frames; with --rig-bias what that leaves
  io::FlightCurves curves;        ///< of every frame
  std::vector<RoadView> views;    ///< of the inspected frames
  std::vector<double> pitch_deg;  ///< of every frame; NaN: unknown
  std::vector<double> valid_share;
  std::vector<double> matching_ms;
  std::vector<double> damage_ms;

  void add(const io::FlightFrame& frame);

  /// Says in how many frames no road was found; empty if in none.
  std::string no_road_text() const;

  /// What the frames tell of a road without damage.
  io::InspectionLimits limits(const std::optional<StereoCalibration>& calibration, const DamageOptions& options) const;

  /// Number of frames that are not good and whose reason is not in `reasons`.
  std::int64_t further_reasons() const { return rejected + failed - static_cast<std::int64_t>(reasons.size()); }

  void add_view(const io::FlightFrame& frame);

  /// Converts the times of the curves to seconds since the first frame if all are known, else to frame numbers.
  void settle_times();
};

}  // namespace roadstereo::cli
