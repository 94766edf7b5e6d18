#pragma once

#include <cstddef>
#include <string>

#include "roadstereo/io/flight_report.hpp"

namespace roadstereo::io {

/// Damages, the worst, that the report has rows for: what links may lead to.
inline constexpr std::size_t max_damage_rows = 200;

/// Draws the positions of the frames and the damages on a map as SVG: north up, metres alike in both directions, with a
/// scale bar. Empty if no frame has a position.
std::string road_map_svg(const FlightReportInput& input);

}  // namespace roadstereo::io
