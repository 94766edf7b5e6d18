#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace roadstereo::io {

/// A serialised message and the time stamp of its image, nanoseconds.
struct TimedMessage {
  std::int64_t stamp_ns = 0;
  std::vector<std::uint8_t> bytes;
};

/// A left and a right message, or an unpaired one with the reason.
struct MatchedMessages {
  std::optional<TimedMessage> left;
  std::optional<TimedMessage> right;
  std::string error;
};

/// Pairs two streams of messages by time stamp: mutual nearest neighbours within a limit. Pairs are returned in
/// chronological order. One stream may lag behind the other by up to `max_waiting` messages.
class NearestPairs {
 public:
  static constexpr std::size_t max_waiting = 32;  ///< messages of one side

  explicit NearestPairs(double limit_s);

  void add_left(TimedMessage message);
  void add_right(TimedMessage message);
  /// Marks the end of both streams.
  void finish() { finished_ = true; }

  /// Returns the next pair or unpaired message, or nullopt if more messages are needed or at the end.
  std::optional<MatchedMessages> next();

 private:
  struct Side {
    std::deque<TimedMessage> waiting;  // sorted by time stamp
    std::optional<std::int64_t> last_stamp_ns;
    TimedMessage take();
  };
  bool can_tell() const;
  std::optional<std::int64_t> distance_ns(std::int64_t stamp_ns, const Side& other) const;
  MatchedMessages alone(bool is_left);

  std::int64_t limit_ns_;
  Side left_;
  Side right_;
  bool finished_ = false;
};

}  // namespace roadstereo::io
