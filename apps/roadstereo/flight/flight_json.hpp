#pragma once

#include <string>

#include "flight/flight_results.hpp"

namespace roadstereo::cli {

/// The content of summary.json. What is not known is null.
std::string flight_json(const FlightSettings& settings, const FlightRun& run, const FlightSummary& summary,
                        const io::FlightInventory& inventory);

}  // namespace roadstereo::cli
