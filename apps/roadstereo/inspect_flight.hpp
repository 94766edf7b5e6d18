#pragma once

#include "flight/flight_settings.hpp"

namespace roadstereo::cli {

/// Thrown if Ctrl-C ended a command.
struct Interrupted {
  const char* message;
};

/// Inspects a recording. Throws Interrupted if it can be resumed, and Error if no frame could be matched.
void inspect_flight(FlightSettings settings);

}  // namespace roadstereo::cli
