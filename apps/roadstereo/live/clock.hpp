#pragma once

#include <chrono>

namespace roadstereo::cli {

/// Monotonic clock of ages and pauses.
using Clock = std::chrono::steady_clock;

inline double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

inline Clock::duration clock_span(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace roadstereo::cli
