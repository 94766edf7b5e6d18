#include "mask_file.hpp"

#include <cstring>

#include "roadstereo/io/image_file.hpp"

namespace roadstereo::cli {
namespace {

/// Sample of a frame of 8 or 16 bits per sample.
int sample_at(const Frame& frame, std::size_t index) {
  if (frame.sample == SampleType::u8) return frame.bytes[index];
  std::uint16_t sample = 0;
  std::memcpy(&sample, &frame.bytes[2 * index], sizeof sample);
  return sample;
}

}  // namespace

Image<std::uint8_t> read_mask(const std::string& path, int threshold) {
  const Frame frame = io::read_frame(path);
  const auto channels = static_cast<std::size_t>(channel_count(frame.order));
  const std::size_t colours = channels == 4 ? 3 : channels;  // without alpha
  Image<std::uint8_t> mask(frame.width, frame.height, 0);
  std::size_t pixel = 0;
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u, ++pixel) {
      for (std::size_t colour = 0; colour < colours; ++colour) {
        if (sample_at(frame, pixel * channels + colour) >= threshold) mask(u, v) = 255;
      }
    }
  }
  return mask;
}

}  // namespace roadstereo::cli
