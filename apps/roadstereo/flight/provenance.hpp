#pragma once

#include "flight/flight_settings.hpp"
#include "roadstereo/io/flight_journal.hpp"

namespace roadstereo::cli {

/// All that the results of a flight depend on, the content of its calibration included: it goes on only with the same.
/// Throws Error naming a calibration that cannot be read.
io::Provenance provenance(const FlightSettings& settings, const PipelineOptions& options);

}  // namespace roadstereo::cli
