// Resampling of frames: exact places of known pictures.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/resampling.hpp"

namespace roadstereo {
namespace {

constexpr int width = 301, height = 157;
constexpr double amplitude = 100, middle = 128;

/// Waves of a length of 8 to 18 pixels, between −1 and 1.
double waves(double x, double y) {
  return 0.4 * std::sin(0.35 * x + 0.2 * y) + 0.4 * std::sin(-0.11 * x + 0.5 * y) + 0.2 * std::sin(0.6 * x + 0.45 * y);
}

template <class Sample>
Frame picture(double scale, SampleType type, int channels, ChannelOrder order) {
  Frame frame{{}, width, height, type, order};
  const std::size_t count = std::size_t{width} * height * static_cast<std::size_t>(channels);
  std::vector<Sample> samples(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t pixel = k / static_cast<std::size_t>(channels);
    const double shift = static_cast<double>(k % static_cast<std::size_t>(channels));
    const double value = waves(static_cast<double>(pixel % width) + shift, static_cast<double>(pixel / width));
    samples[k] = static_cast<Sample>(std::lround(scale * (middle + amplitude * value)));
  }
  frame.bytes.resize(count * sizeof(Sample));
  std::memcpy(frame.bytes.data(), samples.data(), frame.bytes.size());
  return frame;
}

/// Places of a picture that is turned and 1 % smaller, so that all fractions of a pixel occur.
struct Places {
  Image<float> x{width, height}, y{width, height};

  Places() {
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        x(u, v) = 0.99F * static_cast<float>(u) + 0.005F * static_cast<float>(v) + 0.7F;
        y(u, v) = 0.99F * static_cast<float>(v) - 0.002F * static_cast<float>(u) + 0.8F;
      }
    }
  }
};

template <class Sample>
double rms_error(const Frame& frame, const Places& places, double scale, int channels, int channel) {
  constexpr int border = 8;  // the picture goes on beyond it, its reflection does not
  double sum = 0, count = 0;
  for (int v = border; v < height - border; ++v) {
    for (int u = border; u < width - border; ++u) {
      Sample sample{};
      const std::size_t k =
          (static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u)) * static_cast<std::size_t>(channels) +
          static_cast<std::size_t>(channel);
      std::memcpy(&sample, frame.bytes.data() + k * sizeof(Sample), sizeof(Sample));
      const double truth = middle + amplitude * waves(double{places.x(u, v)} + channel, double{places.y(u, v)});
      const double error = sample / scale - truth;
      sum += error * error;
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

// Rounding of the samples before and after leaves 1/√12 each, less where the first is averaged.
TEST(Resampling, AddsNothingToRounding) {
  const Places places;
  for (const ChannelOrder order : {ChannelOrder::grey, ChannelOrder::bgr, ChannelOrder::rgba}) {
    const int channels = channel_count(order);
    const Frame frame = picture<std::uint8_t>(1, SampleType::u8, channels, order);
    const Frame result = resample(frame.view(), places.x, places.y, 2);
    ASSERT_EQ(result.bytes.size(), frame.bytes.size());
    for (int c = 0; c < channels; ++c) {
      EXPECT_LT(rms_error<std::uint8_t>(result, places, 1, channels, c), std::sqrt(2.0 / 12))
          << c << " of " << channels;
    }
    EXPECT_EQ(result.bytes, resample(frame.view(), places.x, places.y, 1).bytes);
  }
}

// Keys' cubic leaves an RMS of 0.07 grey levels here, OpenCV's INTER_CUBIC 0.79.
TEST(Resampling, IsExactWith16Bits) {
  const Places places;
  const Frame frame = picture<std::uint16_t>(200, SampleType::u16, 1, ChannelOrder::grey);
  EXPECT_LT(rms_error<std::uint16_t>(resample(frame.view(), places.x, places.y, 2), places, 200, 1, 0), 0.02);
}

TEST(Resampling, KeepsSamplesAtPixels) {
  const Frame frame = picture<std::uint8_t>(1, SampleType::u8, 1, ChannelOrder::grey);
  Places places;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      places.x(u, v) = static_cast<float>(u);
      places.y(u, v) = static_cast<float>(v);
    }
  }
  EXPECT_EQ(resample(frame.view(), places.x, places.y, 2).bytes, frame.bytes);
}

TEST(Resampling, StaysInRangeAndOnOutermostPixels) {
  Frame frame{{20, 20, 20, 220, 220, 220, 20, 20, 20, 220, 220, 220}, 6, 2, SampleType::u8, ChannelOrder::grey};
  Image<float> x(5, 1), y(5, 1, -3);
  const float nan = std::nanf("");
  const std::array<float, 5> columns{-1e9F, 2.8F, 3.2F, 1e9F, nan};
  std::copy(columns.begin(), columns.end(), x.row(0));
  const Frame result = resample(frame.view(), x, y, 1);
  EXPECT_EQ(result.bytes[0], 20);
  EXPECT_EQ(result.bytes[2], 220) << "a spline overshoots beside an edge";
  EXPECT_EQ(result.bytes[3], 220);
  EXPECT_EQ(result.bytes[4], 20) << "no place";
}

}  // namespace
}  // namespace roadstereo
