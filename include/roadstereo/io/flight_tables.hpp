#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "roadstereo/io/flight_frame.hpp"

namespace roadstereo::io {

// Tables over all frames of a flight, line by line (RFC 4180: CRLF). What is not known is empty.

/// Names of the columns of frames.csv: a row a frame, whatever became of it.
std::string frames_csv_names();
std::string frames_csv_row(const FlightFrame& frame);

/// Names of the columns of damages.csv: the damage of the road (FlightInventory), frame, name and time_s, then those of
/// a single frame's damages.csv.
std::string flight_damages_csv_names();
/// A row a damage of this frame; `road_damages` are their numbers over the flight.
std::string flight_damages_csv_rows(const FlightFrame& frame, const std::vector<std::int64_t>& road_damages);

}  // namespace roadstereo::io
