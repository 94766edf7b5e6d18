#include "evaluation/tint.hpp"

#include "io/frame_mat.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {

Frame tint_magenta(const FrameView& frame, double white_level, ImageView<const std::uint8_t> mask) {
  if (mask.width() != frame.width || mask.height() != frame.height) {
    fail("the mask has ", mask.width(), "×", mask.height(), " pixels, but the image has ", frame.width, "×",
         frame.height);
  }
  const cv::Vec3d magenta(255, 0, 255);
  constexpr double veil = 0.4;
  const bool wide = frame.sample == SampleType::u16;
  const double white = white_level > 0 ? white_level : (wide ? 65535.0 : 255.0);
  cv::Mat picture = to_bgr(frame, white);
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      auto& pixel = picture.at<cv::Vec3b>(v, u);
      if (mask(u, v) != 0) pixel = cv::Vec3b(cv::Vec3d(pixel) * (1 - veil) + magenta * veil);
    }
  }
  return frame_from(picture, ChannelOrder::bgr);
}

}  // namespace roadstereo::io
