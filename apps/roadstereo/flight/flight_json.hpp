#pragma once

#include <string>

#include "flight/flight_results.hpp"

namespace roadstereo::cli {

/// Returns the content of summary.json; `damages` are those of the road without candidates. Unknown values are null.
std::string flight_json(const FlightSettings& settings, const FlightRun& run, const FlightSummary& summary,
                        const std::vector<io::RoadDamage>& damages);

}  // namespace roadstereo::cli
