#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "roadstereo/io/flight_frame.hpp"

namespace roadstereo::cli {

/// Health of a rig over a flight: medians of what the frames show, and what only successive frames show.
class FlightHealth {
 public:
  void add(const io::FlightFrame& frame);

  /// Adds what the trajectory tells.
  void add(const HealthFinding& finding) { of_trajectory_.push_back(finding); }

  /// Median of every number over the frames that have it, at least a tenth of them, and the spots that were found last.
  PairHealth typical() const;
  /// Standard deviation of the rows' offset from frame to frame, pixels; NaN unknown.
  double vibration_px() const;
  /// Pairs in the gaps in the times of more than one and a half periods.
  double missing_pairs() const;
  /// Share of the pairs that are missing or without a result, 0 … 1: rejected, failed, or in a gap.
  double lost_share() const;
  /// Findings of `typical`, vibration, lost pairs and what the trajectory tells.
  std::vector<HealthFinding> findings() const;
  /// Number of frames with each finding, by id, and with each of the warnings unexpected-pose and road-anew.
  const std::map<std::string, std::int64_t>& frames_with() const { return frames_with_; }

 private:
  std::int64_t frames_ = 0, without_result_ = 0;
  std::vector<PairHealth> of_frames_;
  std::vector<HealthFinding> of_trajectory_;
  std::vector<double> times_s_;  // not finite: unknown
  std::map<std::string, std::int64_t> frames_with_;
};

}  // namespace roadstereo::cli
