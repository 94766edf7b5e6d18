#pragma once

#include "flight/flight_settings.hpp"

namespace roadstereo::cli {

/// Thrown when Ctrl-C ended a flight; what was done is written and can be gone on with.
struct Interrupted {};

/// Inspects a whole recording. Throws Interrupted, and Error when nothing of it could be matched.
void inspect_flight(const FlightSettings& settings);

}  // namespace roadstereo::cli
