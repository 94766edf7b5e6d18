#include "roadstereo/io/jpeg.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "io/frame_mat.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {

std::vector<std::uint8_t> encode_jpeg(const FrameView& frame, int quality, int max_width) {
  if (frame.sample != SampleType::u8) fail("a JPEG has 8 bits per sample, not 16");
  cv::Mat pixels = frame.order == ChannelOrder::grey ? mat_over(frame) : to_bgr(frame, 255);
  if (pixels.cols > max_width) {
    const double scale = static_cast<double>(max_width) / pixels.cols;
    cv::Mat small;
    cv::resize(pixels, small, {max_width, std::max(1, cvRound(scale * pixels.rows))}, 0, 0, cv::INTER_AREA);
    pixels = small;
  }
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".jpg", pixels, bytes, {cv::IMWRITE_JPEG_QUALITY, quality})) {
    fail<SystemError>("an image of ", frame.width, "×", frame.height, " pixels could not be encoded as JPEG");
  }
  return bytes;
}

}  // namespace roadstereo::io
