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

/// A raw pair to record.
struct RecordedPair {
  Frame left;
  Frame right;
  double time_s = 0;
};

/// Records raw pairs on a low-priority thread. Never blocks the caller: if writing is too slow, pairs are skipped and
/// counted; if it fails, recording stops with a message.
class Recorder {
 public:
  /// Writes one pair atomically. Throws Error.
  using Writer = std::function<void(const RecordedPair&)>;

  Recorder(Writer writer, LiveBoard& board);

  /// Writes the waiting pairs.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Copies the pair to the queue, or skips it if the queue is full.
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
