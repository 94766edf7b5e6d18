#pragma once

#include <nlohmann/json.hpp>

#include "live/live_board.hpp"

namespace roadstereo::cli {

/// Returns the response of /state. Unknown values are null.
nlohmann::ordered_json status_json(const LiveStatus& status, double max_age_s);

nlohmann::ordered_json counts_json(const LiveCounts& counts);
nlohmann::ordered_json latency_json(const LatencyStatistics& latency);

}  // namespace roadstereo::cli
