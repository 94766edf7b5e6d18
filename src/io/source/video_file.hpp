#pragma once

#include <cstdint>
#include <opencv2/videoio.hpp>
#include <optional>
#include <string>

namespace roadstereo::io {

/// The pictures of a video, one after the other. There is no seeking: containers land on key frames, and passing over
/// pictures is exact.
class VideoFile {
 public:
  /// Throws Error naming the file when it cannot be opened as a video.
  explicit VideoFile(std::string name);

  /// Goes to the next picture, whether it can be decoded or not; false at the end.
  bool grab();
  /// The picture that was grabbed, grey where the video has no colours, else BGR; empty when it cannot be had.
  cv::Mat picture();

  const std::string& name() const { return name_; }
  int width() const { return width_; }
  int height() const { return height_; }
  /// Pictures a second, 0 when the video does not say.
  double rate_hz() const { return rate_hz_; }
  std::int64_t grabbed() const { return grabbed_; }
  /// Pictures from first to last as the file states or its length suggests.
  std::optional<std::int64_t> stated_pictures() const { return stated_; }
  /// How many pictures fewer than stated were there at the end; 0 within the few that such a figure may be off.
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
  bool decodable_ = false;  ///< the picture that was grabbed
  int lost_ = 0;            ///< pictures that cannot be decoded before the one that is held
  bool held_ = false;       ///< a picture was grabbed ahead
  std::optional<std::int64_t> stated_;
};

}  // namespace roadstereo::io
