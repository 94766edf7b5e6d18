#pragma once

#include <algorithm>
#include <deque>

#include "live/clock.hpp"

namespace roadstereo::cli {

/// Frame rate over the last two seconds.
class RateMeter {
 public:
  void add(Clock::time_point time) {
    times_.push_back(time);
    forget(time);
  }

  double per_second(Clock::time_point now) {
    forget(now);
    if (times_.size() < 2) return 0;
    // The current gap counts if it is longer than the mean one.
    const double span = seconds_between(times_.front(), times_.back());
    const auto gaps = static_cast<double>(times_.size() - 1);
    const double open = seconds_between(times_.back(), now);
    return gaps / (span + std::max(0.0, open - span / gaps));
  }

 private:
  void forget(Clock::time_point now) {
    while (!times_.empty() && seconds_between(times_.front(), now) > window_s) times_.pop_front();
  }

  static constexpr double window_s = 2;
  std::deque<Clock::time_point> times_;
};

}  // namespace roadstereo::cli
