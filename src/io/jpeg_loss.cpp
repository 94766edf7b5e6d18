#include <opencv2/imgcodecs.hpp>

#include "io/frame_mat.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/image_file.hpp"
#include "roadstereo/io/jpeg.hpp"

namespace roadstereo::io {

Frame with_jpeg_loss(const Frame& frame, int quality) {
  if (quality < 1 || quality > 100) fail("the quality of a JPEG is ", quality, "; it must be between 1 and 100");
  const bool grey = frame.order == ChannelOrder::grey;
  const std::vector<std::uint8_t> bytes = encode_jpeg(frame.view(), quality, frame.width);
  const cv::Mat decoded = cv::imdecode(bytes, grey ? cv::IMREAD_GRAYSCALE : cv::IMREAD_COLOR);
  return frame_from(decoded, grey ? ChannelOrder::grey : ChannelOrder::bgr);
}

}  // namespace roadstereo::io
