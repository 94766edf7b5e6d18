#include "io/source/nearest_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace roadstereo::io {
namespace {

void insert(std::deque<TimedMessage>& waiting, TimedMessage message) {
  const auto later = [](std::int64_t stamp, const TimedMessage& other) { return stamp < other.stamp_ns; };
  waiting.insert(std::upper_bound(waiting.begin(), waiting.end(), message.stamp_ns, later), std::move(message));
}

/// Formats milliseconds with microsecond resolution.
double milliseconds(std::int64_t nanoseconds) {
  return 1e-3 * std::round(1e-3 * static_cast<double>(nanoseconds));
}

}  // namespace

NearestPairs::NearestPairs(double limit_s) : limit_ns_(std::llround(1e9 * limit_s)) {}

void NearestPairs::add_left(TimedMessage message) {
  insert(left_.waiting, std::move(message));
}

void NearestPairs::add_right(TimedMessage message) {
  insert(right_.waiting, std::move(message));
}

TimedMessage NearestPairs::Side::take() {
  TimedMessage message = std::move(waiting.front());
  waiting.pop_front();
  last_stamp_ns = message.stamp_ns;
  return message;
}

/// Needs two messages of each side: the partner and the next one for comparison.
bool NearestPairs::can_tell() const {
  const std::size_t left = left_.waiting.size();
  const std::size_t right = right_.waiting.size();
  if (finished_) return left + right > 0;
  return (left >= 2 && right >= 2) || left >= max_waiting || right >= max_waiting;
}

std::optional<std::int64_t> NearestPairs::distance_ns(std::int64_t stamp_ns, const Side& other) const {
  std::optional<std::int64_t> nearest;
  if (other.last_stamp_ns) nearest = std::abs(stamp_ns - *other.last_stamp_ns);
  if (!other.waiting.empty()) {
    const std::int64_t distance = std::abs(stamp_ns - other.waiting.front().stamp_ns);
    nearest = nearest ? std::min(*nearest, distance) : distance;
  }
  return nearest;
}

MatchedMessages NearestPairs::alone(bool is_left) {
  TimedMessage message = (is_left ? left_ : right_).take();
  const std::optional<std::int64_t> distance = distance_ns(message.stamp_ns, is_left ? right_ : left_);
  std::ostringstream reason;
  reason << "the " << (is_left ? "left" : "right") << " image is unpaired";
  if (distance) {
    reason << ": the nearest " << (is_left ? "right" : "left") << " one is " << milliseconds(*distance) << " ms away"
           << (*distance <= limit_ns_ ? ", but is paired with another" : ", more than ");
    if (*distance > limit_ns_) reason << milliseconds(limit_ns_) << " ms";
  }
  MatchedMessages result;
  (is_left ? result.left : result.right) = std::move(message);
  result.error = reason.str();
  return result;
}

std::optional<MatchedMessages> NearestPairs::next() {
  if (!can_tell()) return std::nullopt;
  if (left_.waiting.empty()) return alone(false);
  if (right_.waiting.empty()) return alone(true);
  const bool left_first = left_.waiting.front().stamp_ns <= right_.waiting.front().stamp_ns;
  const Side& early = left_first ? left_ : right_;
  const std::int64_t late_ns = (left_first ? right_ : left_).waiting.front().stamp_ns;
  const std::int64_t distance = late_ns - early.waiting.front().stamp_ns;
  const bool next_is_nearer = early.waiting.size() > 1 && std::abs(early.waiting[1].stamp_ns - late_ns) < distance;
  if (distance > limit_ns_ || next_is_nearer) return alone(left_first);
  MatchedMessages result;
  result.left = left_.take();
  result.right = right_.take();
  return result;
}

}  // namespace roadstereo::io
