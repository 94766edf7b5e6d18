#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "live/recorder.hpp"

namespace roadstereo::cli {

/// A folder that `roadstereo inspect` reads: left/NNNNNN.png, right/NNNNNN.png, times.txt (seconds, one a line) and the
/// calibration. Pictures appear whole or not at all, and with both views.
class RecordingFolder {
 public:
  /// Makes the folder when it is missing and copies the calibration files into it. Throws Error naming it when it
  /// cannot be written to or holds a recording already.
  RecordingFolder(std::filesystem::path folder, const std::vector<std::string>& calibration);
  ~RecordingFolder();
  RecordingFolder(const RecordingFolder&) = delete;
  RecordingFolder& operator=(const RecordingFolder&) = delete;

  /// Adds a calibration that has no file.
  void add_calibration(const std::string& name, const std::string& text);

  /// Throws SystemError naming the file when it cannot be written; what was written of the pair is removed.
  void write(const RecordedPair& pair);

 private:
  void write_time(double time_s);

  std::filesystem::path folder_;
  std::int64_t pairs_ = 0;
  int times_ = -1;  ///< file descriptor of times.txt
};

}  // namespace roadstereo::cli
