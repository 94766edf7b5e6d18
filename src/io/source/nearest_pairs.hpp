#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace roadstereo::io {

/// A message as it lies in the recording, and when its picture was taken, nanoseconds.
struct TimedMessage {
  std::int64_t stamp_ns = 0;
  std::vector<std::uint8_t> bytes;
};

/// A left and a right message; or one of them that has no partner, and the reason.
struct MatchedMessages {
  std::optional<TimedMessage> left;
  std::optional<TimedMessage> right;
  std::string refused;
};

/// Pairs two streams of messages by their stamps: each goes with the other's nearest, if that is not nearer to another
/// and not farther than a limit. Pairs come in the order of time. Keeps a few messages only: a stream may lag behind
/// the other by up to `max_waiting`.
class NearestPairs {
 public:
  static constexpr std::size_t max_waiting = 32;  ///< messages of one side

  explicit NearestPairs(double limit_s);

  void add_left(TimedMessage message);
  void add_right(TimedMessage message);
  /// No more come.
  void finish() { finished_ = true; }

  /// The next pair or message without partner; nothing while more messages are needed to tell, and at the end.
  std::optional<MatchedMessages> next();

 private:
  struct Side {
    std::deque<TimedMessage> waiting;  // in the order of stamps
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
