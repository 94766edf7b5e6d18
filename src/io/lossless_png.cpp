#include "io/lossless_png.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "io/frame_mat.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {

std::vector<std::uint8_t> encode_lossless_png(const FrameView& frame, int level) {
  cv::Mat pixels = mat_over(frame);
  if (frame.order == ChannelOrder::rgb || frame.order == ChannelOrder::rgba) {
    cv::Mat swapped;
    cv::cvtColor(pixels, swapped, frame.order == ChannelOrder::rgb ? cv::COLOR_RGB2BGR : cv::COLOR_RGBA2BGRA);
    pixels = swapped;
  }
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", pixels, bytes, {cv::IMWRITE_PNG_COMPRESSION, level})) {
    fail<SystemError>("an image of ", frame.width, "×", frame.height, " pixels could not be encoded as PNG");
  }
  return bytes;
}

}  // namespace roadstereo::io
