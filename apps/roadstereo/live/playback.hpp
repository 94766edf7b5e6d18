#pragma once

#include <cstdint>
#include <optional>

#include "live/clock.hpp"
#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::cli {

/// When the pairs of a recording come due: in real time, as they did when they were taken.
class Playback {
 public:
  /// `rate_hz`: pairs a second; 0 plays at the recording's own times.
  explicit Playback(double rate_hz) : rate_hz_(rate_hz) {}

  /// When this pair comes due. The first one is due now; after times that go back, time begins anew. Throws Error when
  /// there is neither a rate nor a time.
  Clock::time_point due(const io::SourcePair& pair, Clock::time_point now);

  /// How many pairs come due before the newest that is due by now, and are not worth decoding any more.
  std::int64_t overdue(Clock::time_point now) const;

  /// The recording begins again after its last pair.
  void begin_again();

 private:
  double place_s(const io::SourcePair& pair) const;

  double rate_hz_;
  std::optional<double> interval_s_;  ///< between two pairs, as far as seen
  bool started_ = false;
  bool again_ = false;  ///< the next pair is the first of another round
  double first_s_ = 0;  ///< place of the pair that was due at `start_`
  double last_s_ = 0;
  std::int64_t last_index_ = 0;
  Clock::time_point start_{};
  Clock::time_point last_due_{};
};

}  // namespace roadstereo::cli
