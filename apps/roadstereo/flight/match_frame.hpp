#pragma once

#include "auto_mask.hpp"
#include "flight/flight_job.hpp"

namespace roadstereo::cli {

/// Matches the pair of the job and fills its frame record. A rejected pair, or one that cannot be matched, is recorded
/// with its reason. `watch` and `mask` see the frames in order.
void match_frame(Pipeline& pipeline, const std::optional<StereoCalibration>& calibration, PairWatch& watch,
                 AutoMask& mask, FlightJob& job);

/// Records a rejected pair before the first match; `before` is the last frame of an earlier run.
void record_rejected(const std::optional<io::FlightFrame>& before, FlightJob& job);

}  // namespace roadstereo::cli
