#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "live/clock.hpp"
#include "live/recorder.hpp"

namespace roadstereo::cli {

/// Writes a recording for `roadstereo inspect`: left/NNNNNN.png, right/NNNNNN.png, times.txt (seconds, one per line)
/// and calibration.yaml. Pairs are written atomically, and are on the disk about a second later.
class RecordingFolder {
 public:
  /// Creates the folder if it is missing; `calibration`: text of its file, empty without one. Throws Error naming the
  /// folder if it cannot be written to or already contains a recording.
  RecordingFolder(std::filesystem::path folder, const std::string& calibration);
  ~RecordingFolder();
  RecordingFolder(const RecordingFolder&) = delete;
  RecordingFolder& operator=(const RecordingFolder&) = delete;

  /// Writes a pair. Throws SystemError naming the file on failure; a partly written pair is removed.
  void write(const RecordedPair& pair);

 private:
  void create(const std::string& calibration);
  void remove_empty() const;
  void write_time(double time_s);
  void save_now_and_then();

  std::filesystem::path folder_;
  std::int64_t pairs_ = 0;
  bool wrote_calibration_ = false;
  int times_ = -1;  ///< file descriptor of times.txt
  Clock::time_point saved_{};
};

}  // namespace roadstereo::cli
