#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "live/live_board.hpp"
#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::cli {

/// A raw pair to keep.
struct RecordedPair {
  Frame left;
  Frame right;
  double time_s = 0;
};

/// Records raw pairs on a thread of its own, which gives way to all others. What it cannot keep up with is left out and
/// counted; when writing fails, recording stops with a message. Never keeps the caller waiting.
class Recorder {
 public:
  /// Writes one pair, whole or not at all. Throws Error.
  using Writer = std::function<void(const RecordedPair&)>;

  Recorder(Writer writer, LiveBoard& board);

  /// Writes what waits.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Copies the pair when there is room for it.
  void offer(const io::SourcePair& pair, double time_s);

  static constexpr std::size_t max_waiting = 8;  ///< pairs

 private:
  void run();
  std::unique_ptr<RecordedPair> next();
  void stop_with(const char* message);

  Writer writer_;
  LiveBoard& board_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::unique_ptr<RecordedPair>> waiting_;
  RecordingState state_;
  bool closing_ = false;
  std::thread thread_;
};

}  // namespace roadstereo::cli
