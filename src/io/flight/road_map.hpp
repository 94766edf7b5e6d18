#pragma once

#include <string>

#include "roadstereo/io/flight_report.hpp"

namespace roadstereo::io {

/// Draws the positions of the frames and the damages on a map as SVG: north up, metres alike in both directions, with a
/// scale bar. Empty if no frame has a position.
std::string road_map_svg(const FlightReportInput& input);

}  // namespace roadstereo::io
