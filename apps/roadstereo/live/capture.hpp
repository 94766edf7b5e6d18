#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "live/captured_pair.hpp"
#include "live/latest_value.hpp"
#include "live/live_board.hpp"
#include "live/playback.hpp"
#include "live/recorder.hpp"
#include "live/retry_pause.hpp"

namespace roadstereo::cli {

/// Opens the source; called again to get a lost camera back and for another round of a recording. Throws Error.
using SourceOpener = std::function<std::unique_ptr<io::FrameSource>()>;

struct CaptureOptions {
  double rate_hz = 0;  ///< of a recording, pairs a second; 0: at its own times
  bool loop = false;   ///< a recording begins again
  RetryPause pause;    ///< between attempts to get a camera back
};

/// Takes pairs from a source as they come, or as they come due, and puts the newest into a slot.
class Capture {
 public:
  /// `recorder` may be null.
  Capture(std::unique_ptr<io::FrameSource> first, SourceOpener opener, const CaptureOptions& options, LiveBoard& board,
          LatestValue<CapturedPair>& slot, Recorder* recorder);

  /// Until it is told to stop, or a recording ends. Throws Error when a recording cannot be read any further.
  void run(const std::stop_token& stop);

 private:
  std::optional<io::SourcePair> next_of_camera();
  std::optional<io::SourcePair> next_of_recording(const std::stop_token& stop);
  void lose(const std::string& reason);
  void reconnect(const std::stop_token& stop);
  void skip_overdue();
  void count_skipped(const io::SourcePair& pair);
  void deliver(io::SourcePair pair);
  void sleep_until(Clock::time_point time, const std::stop_token& stop);

  std::unique_ptr<io::FrameSource> source_;  ///< none while the camera is lost
  SourceOpener opener_;
  CaptureOptions options_;
  LiveBoard& board_;
  LatestValue<CapturedPair>& slot_;
  Recorder* recorder_;
  bool live_;
  bool ended_ = false;
  Playback playback_;
  std::int64_t next_index_ = 0;  ///< of the recording
  std::mutex mutex_;             ///< of the pauses
  std::condition_variable_any stopped_;
};

}  // namespace roadstereo::cli
