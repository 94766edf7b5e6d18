#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "roadstereo/io/flight_frame.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

// CSV tables of a flight, line by line (RFC 4180: CRLF). Unknown values are empty.

/// Header line of frames.csv: one row per frame, good or not.
std::string frames_csv_names();
std::string frames_csv_row(const FlightFrame& frame);

/// Header line of sightings.csv: id of the road damage (FlightInventory), frame, name and time_s, then the columns of a
/// single frame's damages.csv.
std::string sightings_csv_names();
/// One row per damage of the frame; `road_damages` begins with their ids in the flight.
std::string sightings_csv_rows(const FlightFrame& frame, const std::vector<std::int64_t>& road_damages);

}  // namespace roadstereo::io
#pragma GCC visibility pop
