#pragma once

#include <string>

#include "roadstereo/synth.hpp"

namespace roadstereo::cli {

/// The text that stands for a flight without figures of its own.
inline constexpr const char* usual_flight = "default";

/// Reads a flight such as "roll=6,pitch=4,climb=0.5,period=100,step=0.1,jump=150". What is not given stays as
/// FlightPath has it; `jump` may be given several times. Throws Error naming the key, what it got and what it takes.
synth::FlightPath parse_flight(const std::string& text);

/// The keys and their usual values, a line each, for --help.
std::string flight_help();

}  // namespace roadstereo::cli
