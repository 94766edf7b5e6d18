#pragma once

#include <string>

#include "live/live_board.hpp"

namespace roadstereo::cli {

/// Results of a finished run.
struct LiveSummary {
  std::string source;  ///< description of the source
  double seconds = 0;  ///< duration of the run
  LiveStatus status;
  LatencyStatistics latency;  ///< of all frames
};

std::string summary_text(const LiveSummary& summary);

/// Returns JSON including the peak memory use.
std::string summary_json(const LiveSummary& summary);

}  // namespace roadstereo::cli
