#include "evaluate/mask_file.hpp"

#include <algorithm>

#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {

Image<std::uint8_t> read_mask(const std::string& path) {
  const Frame frame = io::read_frame(path);
  const bool alpha = frame.order == ChannelOrder::bgra || frame.order == ChannelOrder::rgba;
  const std::ptrdiff_t sample_bytes = frame.sample == SampleType::u16 ? 2 : 1;
  const std::ptrdiff_t pixel_bytes = channel_count(frame.order) * sample_bytes;
  const std::ptrdiff_t colour_bytes = alpha ? pixel_bytes - sample_bytes : pixel_bytes;
  Image<std::uint8_t> mask(frame.width, frame.height);
  auto pixel = frame.bytes.begin();
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u, pixel += pixel_bytes) {
      const bool set = std::any_of(pixel, pixel + colour_bytes, [](std::uint8_t byte) { return byte != 0; });
      mask(u, v) = set ? 255 : 0;
    }
  }
  return mask;
}

}  // namespace roadstereo::cli
