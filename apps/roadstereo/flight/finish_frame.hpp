#pragma once

#include <optional>
#include <vector>

#include "flight/flight_job.hpp"
#include "flight/flight_settings.hpp"

namespace roadstereo::cli {

/// Finds the damage of a matched frame and encodes the requested files.
void finish_frame(const std::optional<StereoCalibration>& calibration, const DamageOptions& options,
                  const std::vector<FrameFile>& write, FlightJob& job);

}  // namespace roadstereo::cli
