#include <cstdint>
#include <cstdlib>

#include "core/grey_weights.hpp"
#include "core/image_limits.hpp"
#include "core/require_size.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {
namespace {

/// Shares of the samples of one pixel in its grey value.
struct Shares {
  double first;
  double second;
  double third;
};

Shares shares_of(ChannelOrder order) {
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
void convert(const FrameView& frame, const GreyWeights& weights, GreyImage& grey) {
  const int channels = channel_count(frame.order);
  for (int v = 0; v < frame.height; ++v) {
    const auto* bytes = static_cast<const std::uint8_t*>(frame.data) + v * frame.stride_bytes;
    const auto* in = reinterpret_cast<const Sample*>(bytes);
    std::int16_t* out = grey.row(v);
    if (channels == 1) {
      for (int u = 0; u < frame.width; ++u) out[u] = grey_level(weights, static_cast<float>(in[u]));
    } else {
      for (int u = 0; u < frame.width; ++u, in += channels) {
        out[u] = grey_level(weights, static_cast<float>(in[0]), static_cast<float>(in[1]), static_cast<float>(in[2]));
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

namespace {

std::ptrdiff_t bytes_per_sample(SampleType sample) {
  return sample == SampleType::u16 ? 2 : 1;
}

std::ptrdiff_t bytes_per_row(int width, SampleType sample, ChannelOrder order) {
  return bytes_per_sample(sample) * channel_count(order) * width;
}

FrameView view_of(const void* data, int width, int height, std::ptrdiff_t stride_bytes, SampleType sample,
                  ChannelOrder order) {
  return {data, width, height, stride_bytes == 0 ? bytes_per_row(width, sample, order) : stride_bytes, sample, order};
}

/// Samples of 16 bits are read as such, and rows do not overlap.
void require_layout(const FrameView& frame) {
  const std::ptrdiff_t sample_bytes = bytes_per_sample(frame.sample);
  const std::ptrdiff_t row_bytes = bytes_per_row(frame.width, frame.sample, frame.order);
  if (std::abs(frame.stride_bytes) < row_bytes) {
    fail("the image's rows are ", frame.stride_bytes, " bytes apart; ", frame.width, " pixels need ", row_bytes);
  }
  const auto address = reinterpret_cast<std::intptr_t>(frame.data);
  if (address % sample_bytes != 0) fail("the image has samples of 16 bits at an odd address; it must be even");
  if (frame.stride_bytes % sample_bytes != 0) {
    fail("the image has samples of 16 bits and rows ", frame.stride_bytes, " bytes apart; that must be even");
  }
}

}  // namespace

FrameView Frame::view() const {
  return view_of(bytes.data(), width, height, 0, sample, order);
}

FrameView FrameView::grey8(const std::uint8_t* data, int width, int height, std::ptrdiff_t stride_bytes) {
  return view_of(data, width, height, stride_bytes, SampleType::u8, ChannelOrder::grey);
}

FrameView FrameView::grey16(const std::uint16_t* data, int width, int height, std::ptrdiff_t stride_bytes) {
  return view_of(data, width, height, stride_bytes, SampleType::u16, ChannelOrder::grey);
}

FrameView FrameView::bgr8(const std::uint8_t* data, int width, int height, std::ptrdiff_t stride_bytes) {
  return view_of(data, width, height, stride_bytes, SampleType::u8, ChannelOrder::bgr);
}

FrameView FrameView::bgr16(const std::uint16_t* data, int width, int height, std::ptrdiff_t stride_bytes) {
  return view_of(data, width, height, stride_bytes, SampleType::u16, ChannelOrder::bgr);
}

FrameView FrameView::rgb8(const std::uint8_t* data, int width, int height, std::ptrdiff_t stride_bytes) {
  return view_of(data, width, height, stride_bytes, SampleType::u8, ChannelOrder::rgb);
}

FrameView FrameView::rgb16(const std::uint16_t* data, int width, int height, std::ptrdiff_t stride_bytes) {
  return view_of(data, width, height, stride_bytes, SampleType::u16, ChannelOrder::rgb);
}

FrameView FrameView::bgra8(const std::uint8_t* data, int width, int height, std::ptrdiff_t stride_bytes) {
  return view_of(data, width, height, stride_bytes, SampleType::u8, ChannelOrder::bgra);
}

FrameView FrameView::bgra16(const std::uint16_t* data, int width, int height, std::ptrdiff_t stride_bytes) {
  return view_of(data, width, height, stride_bytes, SampleType::u16, ChannelOrder::bgra);
}

FrameView FrameView::rgba8(const std::uint8_t* data, int width, int height, std::ptrdiff_t stride_bytes) {
  return view_of(data, width, height, stride_bytes, SampleType::u8, ChannelOrder::rgba);
}

FrameView FrameView::rgba16(const std::uint16_t* data, int width, int height, std::ptrdiff_t stride_bytes) {
  return view_of(data, width, height, stride_bytes, SampleType::u16, ChannelOrder::rgba);
}

void require_image_size(int width, int height) {
  if (width >= min_image_side && height >= min_image_side && width <= max_image_side && height <= max_image_side)
    return;
  fail("the image has ", width, "×", height, " pixels; it must have between ", min_image_side, "×", min_image_side,
       " and ", max_image_side, "×", max_image_side);
}

double white_sample(SampleType type, double white_level) {
  const double largest = type == SampleType::u16 ? 65535 : 255;
  if (!(white_level >= 0 && white_level <= largest)) {
    fail("white_level is ", white_level, "; it must be between 0 (the sample type's largest) and ", largest);
  }
  return white_level > 0 ? white_level : largest;
}

GreyWeights grey_weights(const FrameView& frame, double white_level) {
  if (frame.data == nullptr) fail("the image has no data");
  require_image_size(frame.width, frame.height);
  require_layout(frame);
  const double scale = grey_max / white_sample(frame.sample, white_level);
  const Shares shares = shares_of(frame.order);
  return {static_cast<float>(shares.first * scale), static_cast<float>(shares.second * scale),
          static_cast<float>(shares.third * scale), static_cast<float>(grey_max)};
}

void to_grey(const FrameView& frame, double white_level, GreyImage& grey) {
  const GreyWeights weights = grey_weights(frame, white_level);
  grey.resize(frame.width, frame.height);
  if (frame.sample == SampleType::u16) {
    convert<std::uint16_t>(frame, weights, grey);
  } else {
    convert<std::uint8_t>(frame, weights, grey);
  }
}

}  // namespace roadstereo
