#pragma once

#include <string>

#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// The text for a flight with default parameters.
inline constexpr const char* default_flight = "default";

/// Parses a flight such as "roll=6,pitch=4,climb=0.5,period=100,step=0.1,jump=150". Missing keys keep the default of
/// FlightPath; `jump` may be repeated. Throws Error naming the key and the value.
synth::FlightPath parse_flight(const std::string& text);

/// Returns the help text of the keys and their default values.
std::string flight_help();

}  // namespace roadstereo::cli
