#pragma once

#include <atomic>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "first_exception.hpp"
#include "live/capture.hpp"
#include "live/live_board.hpp"
#include "live/processing.hpp"
#include "live/recorder.hpp"

namespace roadstereo::cli {

struct LiveOptions {
  ProcessingOptions processing;
  CaptureOptions capture;
  std::vector<std::string> calibration;  ///< empty, one file, or two: left and right
  double max_age_s = 0.5;                ///< older pairs are not processed, older views are stale
  std::string record;                    ///< folder; empty: no recording
};

/// One live run: threads for capture, matching, damage, the path of the camera and recording that report to a
/// LiveBoard.
class LiveSession {
 public:
  /// Opens the source. Throws Error if the source, the calibration or the folder of the recording cannot be opened.
  LiveSession(const LiveOptions& options, SourceOpener opener);

  /// Stops the run.
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  /// Starts the threads. Throws std::system_error if the system refuses one.
  void start();

  LiveBoard& board() { return board_; }
  const std::string& description() const { return description_; }  ///< of the source

  /// Whether the recording has ended or a thread has failed.
  bool finished() const { return finished_; }

  /// Stops reading, and finishes all pairs already read and the recording.
  void stop();

  /// The same, and sets the board to ended. Rethrows the first exception of a thread.
  void end();

 private:
  void start_threads();

  LiveBoard board_;
  LatestValue<CapturedPair> captured_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<Capture> capture_;
  std::unique_ptr<Processing> processing_;
  std::string description_;
  std::atomic<bool> finished_ = false;
  FirstException failure_;
  std::jthread capturing_;
  std::thread matching_;
  std::thread finishing_;
  std::thread following_;
};

}  // namespace roadstereo::cli
