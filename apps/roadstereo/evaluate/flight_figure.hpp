#pragma once

#include <vector>

#include "evaluate/flight_trials.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Errors of ψ and of the road model over the frames, carried over and afresh, and the time of each frame.
Frame draw_flight(const std::vector<FlightTrial>& frames);

}  // namespace roadstereo::cli
