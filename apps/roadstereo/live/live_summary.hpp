#pragma once

#include <string>

#include "live/live_board.hpp"

namespace roadstereo::cli {

/// What a run came to, when it has ended.
struct LiveSummary {
  std::string source;  ///< for people
  double seconds = 0;  ///< from the start to the end
  LiveStatus status;
  LatencyFigures latency;  ///< of all frames
};

std::string summary_text(const LiveSummary& summary);

/// The same as JSON, with the peak of memory.
std::string summary_json(const LiveSummary& summary);

}  // namespace roadstereo::cli
