#pragma once

#include <nlohmann/json.hpp>

#include "live/live_board.hpp"

namespace roadstereo::cli {

/// What /state tells the page. What is not known is null.
nlohmann::ordered_json status_json(const LiveStatus& status, double max_age_s);

nlohmann::ordered_json counts_json(const LiveCounts& counts);
nlohmann::ordered_json latency_json(const LatencyFigures& latency);

}  // namespace roadstereo::cli
