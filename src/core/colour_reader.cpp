#include "core/colour_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/grey_weights.hpp"

namespace roadstereo {

ColourReader::ColourReader(const FrameView& image, double white_level)
    : image_(image), scale_(255.0F / static_cast<float>(white_sample(image.sample, white_level))) {}

std::array<float, 3> ColourReader::pixel(int u, int v) const {
  const int channels = channel_count(image_.order);
  const auto* const row = static_cast<const std::uint8_t*>(image_.data) + v * image_.stride_bytes;
  const auto sample = [&](int channel) -> float {
    const std::ptrdiff_t index = static_cast<std::ptrdiff_t>(u) * channels + channel;
    if (image_.sample == SampleType::u8) return row[index];
    std::uint16_t value = 0;
    std::memcpy(&value, row + 2 * index, sizeof value);
    return value;
  };
  const auto level = [&](int channel) { return std::min(255.0F, sample(channel) * scale_); };
  if (channels == 1) {
    const float grey = level(0);
    return {grey, grey, grey};
  }
  const bool red_first = image_.order == ChannelOrder::rgb || image_.order == ChannelOrder::rgba;
  return {level(red_first ? 0 : 2), level(1), level(red_first ? 2 : 0)};
}

std::array<float, 3> ColourReader::at(double u, double v) const {
  const int u0 = std::clamp(static_cast<int>(std::floor(u)), 0, image_.width - 2);
  const int v0 = std::clamp(static_cast<int>(std::floor(v)), 0, image_.height - 2);
  const auto along = static_cast<float>(u - u0), down = static_cast<float>(v - v0);
  const auto a = pixel(u0, v0), b = pixel(u0 + 1, v0), c = pixel(u0, v0 + 1), d = pixel(u0 + 1, v0 + 1);
  std::array<float, 3> colour{};
  for (std::size_t k = 0; k < 3; ++k) {
    const float above = a[k] + along * (b[k] - a[k]);
    const float below = c[k] + along * (d[k] - c[k]);
    colour[k] = std::clamp(above + down * (below - above), 0.0F, 255.0F);
  }
  return colour;
}

}  // namespace roadstereo
