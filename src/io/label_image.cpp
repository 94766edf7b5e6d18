#include "roadstereo/io/label_image.hpp"

#include "roadstereo/io/image_file.hpp"

namespace roadstereo::io {

std::vector<std::uint8_t> encode_label_png(ImageView<const std::uint16_t> labels) {
  const std::ptrdiff_t stride_bytes = labels.stride() * static_cast<std::ptrdiff_t>(sizeof(std::uint16_t));
  return encode_png(FrameView::grey16(labels.row(0), labels.width(), labels.height(), stride_bytes));
}

}  // namespace roadstereo::io
