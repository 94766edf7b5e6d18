#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/require_size.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo {
namespace {

/// Synthetic textured frame to warm up memory and threads; the right one is shifted row by row.
class SyntheticTexture {
 public:
  SyntheticTexture(int width, int height, double white_level, bool right)
      : width_(width), height_(height), samples_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    const double white = white_level > 0 ? std::max(white_level, 1.0) : 65535;
    auto sample = samples_.begin();
    for (int v = 0; v < height; ++v) {
      const int shift = right ? (width + width * v / height) / 32 : 0;
      for (int u = 0; u < width; ++u) *sample++ = static_cast<std::uint16_t>(white * texture(u + shift, v));
    }
  }

  FrameView view() const {
    const std::ptrdiff_t stride_bytes = std::ptrdiff_t{width_} * static_cast<std::ptrdiff_t>(sizeof(std::uint16_t));
    return {samples_.data(), width_, height_, stride_bytes, SampleType::u16, ChannelOrder::grey};
  }

 private:
  /// Grains of 2×2 pixels, 0 … 1.
  static double texture(int u, int v) {
    std::uint32_t h = static_cast<std::uint32_t>(u / 2) * 0x9E3779B1U ^ static_cast<std::uint32_t>(v / 2) * 0x85EBCA77U;
    h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
    h = (h ^ (h >> 12)) * 0x297A2D39U;
    return static_cast<double>(h >> 24) / 255;
  }

  int width_, height_;
  std::vector<std::uint16_t> samples_;
};

}  // namespace

void Pipeline::warm_up(int width, int height) {
  require_image_size(width, height);
  const SyntheticTexture left(width, height, options().white_level, false);
  const SyntheticTexture right(width, height, options().white_level, true);
  constexpr int frames = 2;  // found anew, and carried over
  try {
    for (int frame = 0; frame < frames; ++frame) process(left.view(), right.view());
  } catch (...) {
    reset();
    throw;
  }
  reset();
}

}  // namespace roadstereo
