#pragma once

#include <cstdint>
#include <optional>

#include "live/clock.hpp"
#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::cli {

/// Schedules the pairs of a recording in real time.
class Playback {
 public:
  /// `rate_hz`: pairs per second; 0: times of the recording.
  explicit Playback(double rate_hz) : rate_hz_(rate_hz) {
    if (rate_hz > 0) interval_s_ = 1 / rate_hz;
  }

  /// Returns when the pair is due. The first pair is due now, and so is a rejected one whose time nothing tells; the
  /// schedule restarts if times decrease. Throws Error if there is neither a rate nor a time.
  Clock::time_point due(const io::SourcePair& pair, Clock::time_point now);

  /// Returns the number of pairs to skip: those due before the newest pair that is already due.
  std::int64_t overdue(Clock::time_point now) const;

  /// Restarts the recording after its last pair.
  void begin_again();

 private:
  double position_s(const io::SourcePair& pair) const;

  double rate_hz_;
  std::optional<double> interval_s_;  ///< between two pairs, if known
  bool started_ = false;
  bool again_ = false;  ///< the next pair is the first of a repetition
  double first_s_ = 0;  ///< time of the pair that was due at `start_`
  double last_s_ = 0;
  std::int64_t last_index_ = 0;
  Clock::time_point start_{};
  Clock::time_point last_due_{};
};

}  // namespace roadstereo::cli
