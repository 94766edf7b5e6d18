#pragma once

#include <cstdint>
#include <opencv2/videoio.hpp>
#include <optional>
#include <string>

namespace roadstereo::io {

/// Reads the frames of a video in order. Frames are skipped one by one, because seeking is inexact.
class VideoFile {
 public:
  /// Throws Error naming the file if it cannot be opened as a video.
  explicit VideoFile(std::string name);

  /// Advances to the next frame, even if it cannot be decoded. Returns false at the end.
  bool grab();
  /// Decodes the current frame, grey or BGR; empty on failure.
  cv::Mat picture();

  const std::string& name() const { return name_; }
  int width() const { return width_; }
  int height() const { return height_; }
  /// Frames per second; 0: unknown.
  double rate_hz() const { return rate_hz_; }
  std::int64_t grabbed() const { return grabbed_; }
  /// Number of frames according to the file or its duration.
  std::optional<std::int64_t> stated_pictures() const { return stated_; }
  /// Number of frames missing at the end compared with the stated length; 0 within its tolerance.
  std::int64_t missing_pictures() const;

 private:
  bool find_next();

  std::string name_;
  cv::VideoCapture capture_;
  int width_ = 0;
  int height_ = 0;
  double rate_hz_ = 0;
  bool grey_ = false;
  std::int64_t grabbed_ = 0;
  bool decodable_ = false;  ///< the current frame
  int lost_ = 0;            ///< undecodable frames before the one grabbed ahead
  bool held_ = false;       ///< a frame was grabbed ahead
  std::optional<std::int64_t> stated_;
};

}  // namespace roadstereo::io
