#include <algorithm>
#include <cmath>

#include "roadstereo/error.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {
namespace {

constexpr int min_side = 32;
constexpr int max_side = 8192;

/// Weights of the samples of one pixel in its grey value.
struct GreyWeights {
  double first;
  double second;
  double third;
};

GreyWeights grey_weights(ChannelOrder order) {
  switch (order) {
    case ChannelOrder::bgr:
    case ChannelOrder::bgra:
      return {0.114, 0.587, 0.299};
    case ChannelOrder::rgb:
    case ChannelOrder::rgba:
      return {0.299, 0.587, 0.114};
    case ChannelOrder::grey:
      break;
  }
  return {1, 0, 0};
}

template <class Sample>
void convert(const FrameView& frame, double white_level, GreyImage& grey) {
  const int channels = channel_count(frame.order);
  const GreyWeights weights = grey_weights(frame.order);
  const double scale = grey_max / white_level;
  const auto first = static_cast<float>(weights.first * scale);
  const auto second = static_cast<float>(weights.second * scale);
  const auto third = static_cast<float>(weights.third * scale);
  const auto level = [](float value) {
    return static_cast<std::int16_t>(std::min(value + 0.5f, static_cast<float>(grey_max)));
  };
  for (int v = 0; v < frame.height; ++v) {
    const auto* bytes = static_cast<const std::uint8_t*>(frame.data) + v * frame.stride_bytes;
    const auto* in = reinterpret_cast<const Sample*>(bytes);
    std::int16_t* out = grey.row(v);
    if (channels == 1) {
      for (int u = 0; u < frame.width; ++u) out[u] = level(first * static_cast<float>(in[u]));
    } else {
      for (int u = 0; u < frame.width; ++u, in += channels) {
        out[u] = level(first * static_cast<float>(in[0]) + second * static_cast<float>(in[1]) +
                       third * static_cast<float>(in[2]));
      }
    }
  }
}

}  // namespace

int channel_count(ChannelOrder order) {
  switch (order) {
    case ChannelOrder::grey:
      return 1;
    case ChannelOrder::bgr:
    case ChannelOrder::rgb:
      return 3;
    case ChannelOrder::bgra:
    case ChannelOrder::rgba:
      return 4;
  }
  return 1;
}

FrameView Frame::view() const {
  const std::ptrdiff_t sample_bytes = sample == SampleType::u16 ? 2 : 1;
  return {bytes.data(), width, height, sample_bytes * channel_count(order) * width, sample, order};
}

void to_grey(const FrameView& frame, double white_level, GreyImage& grey) {
  if (frame.data == nullptr) fail("the image has no data");
  if (frame.width < min_side || frame.height < min_side || frame.width > max_side || frame.height > max_side) {
    fail("the image has ", frame.width, "×", frame.height, " pixels; it must have between ", min_side, "×", min_side,
         " and ", max_side, "×", max_side);
  }
  const double largest = frame.sample == SampleType::u16 ? 65535 : 255;
  if (!(white_level >= 0 && white_level <= largest)) {
    fail("white_level is ", white_level, "; it must be between 0 (the sample type's largest) and ", largest);
  }
  const double white = white_level > 0 ? white_level : largest;
  grey.resize(frame.width, frame.height);
  if (frame.sample == SampleType::u16) {
    convert<std::uint16_t>(frame, white, grey);
  } else {
    convert<std::uint8_t>(frame, white, grey);
  }
}

}  // namespace roadstereo
