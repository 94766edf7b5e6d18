#pragma once

#include <optional>

#include "flight/flight_job.hpp"
#include "flight/flight_settings.hpp"

namespace roadstereo::cli {

/// Finds the damage of a matched frame and encodes the requested files and messages.
void finish_frame(const std::optional<StereoCalibration>& calibration, const FlightPlan& plan, FlightJob& job);

}  // namespace roadstereo::cli
