#pragma once

#include <optional>
#include <vector>

#include "flight/flight_job.hpp"
#include "flight/flight_settings.hpp"

namespace roadstereo::cli {

/// What becomes of a matched frame: its damage is found and measured, and the files that are asked for are encoded.
void finish_frame(const std::optional<StereoCalibration>& calibration, const PipelineOptions& options,
                  const std::vector<FrameFile>& write, FlightJob& job);

}  // namespace roadstereo::cli
