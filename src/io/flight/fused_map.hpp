#pragma once

#include <string>

#include "roadstereo/io/flight_report.hpp"

namespace roadstereo::io {

/// Returns the section of the map: its picture and the table of its damages.
std::string fused_map_section(const ReportedMap& map);

}  // namespace roadstereo::io
