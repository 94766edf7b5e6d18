#pragma once

#include "flight/flight_job.hpp"

namespace roadstereo::cli {

/// Matches the job's pair and writes down what is known of the frame. A pair that was refused, or cannot be matched, is
/// recorded with its reason.
void match_frame(Pipeline& pipeline, const std::optional<StereoCalibration>& calibration, FlightJob& job);

/// Records a pair that was refused before any pair was matched; `before` is the last frame of an earlier run.
void record_refused(const std::optional<io::FlightFrame>& before, FlightJob& job);

}  // namespace roadstereo::cli
