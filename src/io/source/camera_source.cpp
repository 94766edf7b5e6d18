#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <opencv2/videoio.hpp>
#include <opencv2/videoio/registry.hpp>
#include <sstream>
#include <system_error>

#include "io/source/numbered_pair.hpp"
#include "io/source/sources.hpp"
#include "io/source/split_views.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

double seconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

/// Converts the monotonic time stamp of a driver to system time. Returns the current time if the stamp is missing or of
/// another clock.
double system_time(double monotonic_s) {
  constexpr double oldest_s = 10;
  const double now_s = seconds(std::chrono::system_clock::now().time_since_epoch());
  const double age_s = seconds(std::chrono::steady_clock::now().time_since_epoch()) - monotonic_s;
  return age_s >= 0 && age_s < oldest_s ? now_s - age_s : now_s;
}

/// Throws Error with the system's reason, which OpenCV does not report.
void check_device(const std::string& device) {
  struct stat status {};
  if (::stat(device.c_str(), &status) != 0) {
    fail(device, ": there is no such camera: ", std::generic_category().message(errno));
  }
  if (!S_ISCHR(status.st_mode)) fail(device, ": this is a file, not a camera");
  const int descriptor = ::open(device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  const int reason = errno;
  if (descriptor >= 0) {
    ::close(descriptor);
    return;
  }
  const char* advice = reason == EACCES ? "; add the user to the group \"video\"" : "";
  fail(device, ": the camera cannot be opened: ", std::generic_category().message(reason), advice);
}

class CameraSource final : public FrameSource {
 public:
  CameraSource(const std::string& device, const SourceOptions& options) : device_(device) {
    if (!cv::videoio_registry::hasBackend(cv::CAP_V4L2)) {
      fail(device, ": OpenCV was built without V4L2, which is needed for cameras");
    }
    check_device(device);
    if (!capture_.open(device, cv::CAP_V4L2)) {
      fail(device, ": this is not a camera, it is in use, or its image format is not supported");
    }
    // The driver chooses the nearest mode. Compressed images, because USB is too slow for raw ones.
    capture_.set(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'));
    capture_.set(cv::CAP_PROP_FRAME_WIDTH, options.camera_width);
    capture_.set(cv::CAP_PROP_FRAME_HEIGHT, options.camera_height);
    capture_.set(cv::CAP_PROP_BUFFERSIZE, 2);  // low latency
    width_ = static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH));
    height_ = static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT));
    layout_ = find_layout(device, width_, height_, options.layout);
  }

  std::optional<SourcePair> next() override {
    grab();
    SourcePair pair = numbered_pair(index_++, 0);
    pair.time_s = system_time(1e-3 * capture_.get(cv::CAP_PROP_POS_MSEC));
    cv::Mat picture;
    if (!retrieve(picture) || picture.cols != width_ || picture.rows != height_) {
      pair.error = "the image of the camera cannot be decoded";
    } else {
      split_views(device_, picture, layout_, pair);
    }
    return pair;
  }

  void skip(std::int64_t pairs) override {
    for (; pairs > 0; --pairs, ++index_) grab();
  }

  std::optional<std::int64_t> size() const override { return std::nullopt; }
  bool live() const override { return true; }

  std::string description() const override {
    std::ostringstream text;
    text << "camera " << device_ << ", " << width_ << "×" << height_
         << (layout_ == StereoLayout::side_by_side ? " side by side" : " one above the other");
    return text.str();
  }

 private:
  void grab() {
    if (!capture_.grab()) fail(device_, ": the camera does not deliver images any more; was it unplugged?");
  }

  bool retrieve(cv::Mat& picture) {
    try {
      return capture_.retrieve(picture);
    } catch (const cv::Exception&) {  // a damaged JPEG
      return false;
    }
  }

  std::string device_;
  cv::VideoCapture capture_;
  int width_ = 0;
  int height_ = 0;
  StereoLayout layout_ = StereoLayout::side_by_side;
  std::int64_t index_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_camera(const std::string& device, const SourceOptions& options) {
  return std::make_unique<CameraSource>(device, options);
}

}  // namespace roadstereo::io
