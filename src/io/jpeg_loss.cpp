#include <opencv2/imgcodecs.hpp>

#include "io/frame_mat.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"

namespace roadstereo::io {

Frame with_jpeg_loss(const Frame& frame, int quality) {
  if (quality < 1 || quality > 100) fail("the quality of a JPEG is ", quality, "; it must be between 1 and 100");
  if (frame.sample != SampleType::u8) fail("a JPEG has 8 bits per sample, not 16");
  const bool grey = frame.order == ChannelOrder::grey;
  const cv::Mat pixels = grey ? mat_over(frame.view()) : to_bgr(frame.view(), 255);
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".jpg", pixels, bytes, {cv::IMWRITE_JPEG_QUALITY, quality})) {
    fail<SystemError>("an image could not be encoded as JPEG");
  }
  const cv::Mat decoded = cv::imdecode(bytes, grey ? cv::IMREAD_GRAYSCALE : cv::IMREAD_COLOR);
  return frame_from(decoded, grey ? ChannelOrder::grey : ChannelOrder::bgr);
}

}  // namespace roadstereo::io
