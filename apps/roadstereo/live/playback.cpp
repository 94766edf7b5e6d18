#include "live/playback.hpp"

#include <algorithm>
#include <cmath>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {

/// Time of a pair in the recording, seconds; NaN of a rejected one of which nothing tells it.
double Playback::position_s(const io::SourcePair& pair) const {
  if (rate_hz_ > 0) return static_cast<double>(pair.index) / rate_hz_;
  if (std::isfinite(pair.time_s)) return pair.time_s;
  if (started_ && interval_s_) return last_s_ + *interval_s_;  // a pair without a time, e.g. a rejected one
  if (!pair.error.empty()) return pair.time_s;
  fail("the recording has no times; set --rate");
}

Clock::time_point Playback::due(const io::SourcePair& pair, Clock::time_point now) {
  const double time_s = position_s(pair);
  if (!std::isfinite(time_s)) return now;
  const auto steps = static_cast<double>(pair.index - last_index_);
  if (started_ && !again_ && time_s > last_s_ && steps > 0) interval_s_ = (time_s - last_s_) / steps;
  if (!started_ || again_ || time_s < last_s_) {
    const bool follows = started_ && interval_s_.has_value();
    start_ = follows ? std::max(now, last_due_ + clock_span(*interval_s_)) : now;
    first_s_ = time_s;
    started_ = true;
    again_ = false;
  }
  last_s_ = time_s;
  last_index_ = pair.index;
  last_due_ = start_ + clock_span(time_s - first_s_);
  return last_due_;
}

std::int64_t Playback::overdue(Clock::time_point now) const {
  if (!started_ || !interval_s_) return 0;
  const double late = seconds_between(last_due_, now) / *interval_s_;
  return std::max<std::int64_t>(0, static_cast<std::int64_t>(std::floor(late)) - 1);
}

void Playback::begin_again() {
  again_ = true;
}

}  // namespace roadstereo::cli
