#pragma once

#include <string>

#include "flight/flight_results.hpp"

namespace roadstereo::cli {

/// Returns the content of summary.json. Unknown values are null.
std::string flight_json(const FlightSettings& settings, const FlightRun& run, const FlightSummary& summary,
                        const io::FlightInventory& inventory);

}  // namespace roadstereo::cli
