#include "io/source/video_file.hpp"

#include <cmath>
#include <filesystem>
#include <opencv2/videoio/registry.hpp>

#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

namespace fs = std::filesystem;

void check_ordinary_file(const std::string& name) {
  std::error_code error;
  const fs::file_status status = fs::status(name, error);
  if (status.type() == fs::file_type::not_found) fail(name, ": the file does not exist");
  if (error) fail(name, ": the file cannot be read: ", error.message());
  if (!fs::is_regular_file(status)) fail(name, ": this is not a regular file");
  if (fs::file_size(name, error) == 0) fail(name, ": the file is empty");
}

bool is_grey(const cv::VideoCapture& capture) {
  const auto format = static_cast<int>(capture.get(cv::CAP_PROP_CODEC_PIXEL_FORMAT));
  return format == cv::VideoWriter::fourcc('Y', '8', '0', '0');
}

}  // namespace

VideoFile::VideoFile(std::string name) : name_(std::move(name)) {
  if (!cv::videoio_registry::hasBackend(cv::CAP_FFMPEG)) {
    fail(name_, ": OpenCV was built without FFmpeg, which is needed for videos");
  }
  check_ordinary_file(name_);
  // An absolute path, because FFmpeg takes "a:b.mp4" for a protocol.
  if (!capture_.open(fs::absolute(name_).string(), cv::CAP_FFMPEG)) {
    fail(name_, ": the video cannot be opened; it is damaged, truncated, or of a format that FFmpeg does not support");
  }
  width_ = static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH));
  height_ = static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT));
  if (width_ <= 0 || height_ <= 0) fail(name_, ": the video has no frames");
  constexpr double max_hz = 10000;  // higher values are clock ticks
  const double rate = capture_.get(cv::CAP_PROP_FPS);
  if (rate > 0 && rate <= max_hz) rate_hz_ = rate;
  constexpr double max_pictures = 1e12;
  const double pictures = capture_.get(cv::CAP_PROP_FRAME_COUNT);
  if (pictures > 0 && pictures < max_pictures) stated_ = std::llround(pictures);
  grey_ = is_grey(capture_);
}

/// OpenCV reports a frame that cannot be decoded like the end of the video, but others may follow.
bool VideoFile::find_next() {
  constexpr int max_lost = 64;
  for (int lost = 0; lost < max_lost; ++lost) {
    if (!capture_.grab()) continue;
    lost_ = lost;
    held_ = true;
    return true;
  }
  return false;
}

bool VideoFile::grab() {
  decodable_ = false;
  if (lost_ > 0) {
    --lost_;
  } else if (held_) {
    held_ = false;
    decodable_ = true;
  } else if (capture_.grab()) {
    decodable_ = true;
  } else if (!find_next()) {
    return false;
  }
  ++grabbed_;
  return true;
}

cv::Mat VideoFile::picture() {
  if (!decodable_) return {};
  cv::Mat picture;
  if (!capture_.retrieve(picture)) return {};
  if (!grey_ || picture.channels() == 1) return picture;
  cv::Mat grey;
  cv::extractChannel(picture, grey, 0);
  return grey;
}

std::int64_t VideoFile::missing_pictures() const {
  constexpr std::int64_t tolerated = 2;
  const std::int64_t missing = stated_.value_or(0) - grabbed_;
  return missing > tolerated ? missing : 0;
}

}  // namespace roadstereo::io
