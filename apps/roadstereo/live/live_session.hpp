#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "live/capture.hpp"
#include "live/live_board.hpp"
#include "live/processing.hpp"
#include "live/recorder.hpp"

namespace roadstereo::cli {

struct LiveOptions {
  ProcessingOptions processing;
  CaptureOptions capture;
  std::vector<std::string> calibration;  ///< none, one file, or the two of a ROS pair
  double max_age_s = 0.5;                ///< older pairs are not processed, and what is shown counts as stale
  std::string record;                    ///< folder; empty: nothing is recorded
};

/// A run from its source to the board, on threads of its own: capture, matching, damage, and recording.
class LiveSession {
 public:
  /// Opens the source. Throws Error when the source cannot be opened, the calibration cannot be read, or the
  /// folder of the recording cannot be written to.
  LiveSession(const LiveOptions& options, SourceOpener opener);

  /// Ends the run.
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  /// From here on pairs are taken.
  void start();

  LiveBoard& board() { return board_; }
  const std::string& description() const { return description_; }  ///< of the source, for people

  /// Whether nothing more will come: the recording has ended, or a thread has failed.
  bool finished() const { return finished_; }

  /// Stops taking pairs, finishes those on their way and the recording, and sets the board to ended. Throws what a
  /// thread has failed with.
  void end();

 private:
  void start_recorder(const LiveOptions& options, const io::FrameSource& source);
  void guarded(const std::function<void()>& work);
  void join();

  LiveBoard board_;
  LatestValue<CapturedPair> captured_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<Capture> capture_;
  std::unique_ptr<Processing> processing_;
  std::string description_;
  std::atomic<bool> finished_ = false;
  std::mutex mutex_;
  std::exception_ptr failure_;  ///< the first
  std::jthread capturing_;
  std::thread matching_;
  std::thread finishing_;
};

}  // namespace roadstereo::cli
