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
#include "live/retry_backoff.hpp"

namespace roadstereo::cli {

/// Opens the source; called again to reconnect a camera and to repeat a recording. Throws Error.
using SourceOpener = std::function<std::unique_ptr<io::FrameSource>()>;

struct CaptureOptions {
  double rate_hz = 0;  ///< of a recording, pairs per second; 0: times of the recording
  bool loop = false;   ///< repeats a recording
  RetryBackoff pause;  ///< between attempts to reconnect a camera
};

/// Reads pairs of a camera, or of a recording in real time, and stores the newest in a LatestValue.
class Capture {
 public:
  /// `recorder` may be null.
  Capture(std::unique_ptr<io::FrameSource> first, SourceOpener opener, const CaptureOptions& options, LiveBoard& board,
          LatestValue<CapturedPair>& slot, Recorder* recorder);

  /// Runs until `stop`, or the end of a recording. Throws Error if a recording cannot be read.
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

  std::unique_ptr<io::FrameSource> source_;  ///< null while the camera is lost
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
