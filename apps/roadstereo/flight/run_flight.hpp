#pragma once

#include <cstdint>
#include <optional>

#include "flight/flight_folder.hpp"
#include "flight/flight_record.hpp"
#include "flight/flight_results.hpp"
#include "flight/flight_settings.hpp"
#include "flight/flight_trajectory.hpp"
#include "flight/rectified_source.hpp"
#include "progress.hpp"
#include "stop_signals.hpp"

namespace roadstereo::cli {

/// Inputs and outputs of `run_flight`.
struct Flight {
  RectifiedSource& source;
  FlightFolder& folder;
  FlightRecord& record;
  FlightResults& results;                       ///< of the frames on record
  std::optional<FlightTrajectory>& trajectory;  ///< with --trajectory, from the first matched frame on
  const FlightPlan& plan;
  Progress& progress;
  const StopSignals& stop;
};

/// Processes the frames that are not on record: one thread reads, one matches (with the threads of the options),
/// others find damage and encode; results are written in order. No frame is dropped. Returns true at the end of the
/// source; false after Ctrl-C, when all frames already read are finished.
bool run_flight(const FlightSettings& settings, Flight& flight);

}  // namespace roadstereo::cli
