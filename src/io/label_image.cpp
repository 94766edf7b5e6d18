#include "roadstereo/io/label_image.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "roadstereo/error.hpp"

namespace roadstereo::io {

std::vector<std::uint8_t> encode_label_png(ImageView<const std::uint16_t> labels) {
  cv::Mat picture(labels.height(), labels.width(), CV_16UC1);
  for (int v = 0; v < labels.height(); ++v) {
    std::copy_n(labels.row(v), labels.width(), picture.ptr<std::uint16_t>(v));
  }
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", picture, bytes)) fail<SystemError>("the labels could not be encoded as PNG");
  return bytes;
}

}  // namespace roadstereo::io
