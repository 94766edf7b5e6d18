#pragma once

#include "flight/flight_settings.hpp"

namespace roadstereo::cli {

/// Thrown if Ctrl-C ended a flight; the results so far are written and the flight can be resumed.
struct Interrupted {};

/// Inspects a recording. Throws Interrupted, and Error if no frame could be matched.
void inspect_flight(const FlightSettings& settings);

}  // namespace roadstereo::cli
