#pragma once

#include "flight/flight_settings.hpp"
#include "roadstereo/io/flight_journal.hpp"

namespace roadstereo::cli {

/// Returns all inputs and options that determine the results of a flight, including a hash of its calibration.
/// Throws Error naming a calibration that cannot be read.
io::Provenance provenance(const FlightSettings& settings, const PipelineOptions& options);

}  // namespace roadstereo::cli
