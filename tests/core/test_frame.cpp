// Camera frames to grey: every depth, channel order and stride against values worked out by hand.

#include <gtest/gtest.h>

#include "roadstereo/error.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {
namespace {

template <class Sample>
std::vector<Sample> filled(int channels, std::vector<Sample> pixel, int stride_samples) {
  std::vector<Sample> data(static_cast<std::size_t>(stride_samples) * 40);
  for (int v = 0; v < 40; ++v) {
    for (int u = 0; u < 36; ++u) {
      for (int c = 0; c < channels; ++c) {
        data[static_cast<std::size_t>(v * stride_samples + u * channels + c)] = pixel[static_cast<std::size_t>(c)];
      }
    }
  }
  return data;
}

TEST(Frame, GreyBytesBecomeSixteenths) {
  const auto data = filled<std::uint8_t>(1, {100}, 50);
  GreyImage grey;
  to_grey({data.data(), 36, 40, 50, SampleType::u8, ChannelOrder::grey}, 0, grey);
  EXPECT_EQ(grey.width(), 36);
  EXPECT_EQ(grey.height(), 40);
  EXPECT_EQ(grey(35, 39), 1600);
}

TEST(Frame, ColourIsWeightedByRec601) {
  GreyImage bgr, rgba;
  const auto blue_first = filled<std::uint8_t>(3, {10, 20, 200}, 120);
  to_grey({blue_first.data(), 36, 40, 120, SampleType::u8, ChannelOrder::bgr}, 0, bgr);
  const auto red_first = filled<std::uint8_t>(4, {200, 20, 10, 77}, 150);
  to_grey({red_first.data(), 36, 40, 150, SampleType::u8, ChannelOrder::rgba}, 0, rgba);
  // 0.299·200 + 0.587·20 + 0.114·10 = 72.68 grey levels = 1162.88 sixteenths
  EXPECT_EQ(bgr(3, 3), 1163);
  EXPECT_EQ(rgba(35, 39), 1163);
}

TEST(Frame, SixteenBitsUseWhiteLevel) {
  const auto data = filled<std::uint16_t>(1, {2048}, 40);
  GreyImage grey;
  const FrameView view{data.data(), 36, 40, 80, SampleType::u16, ChannelOrder::grey};
  to_grey(view, 4095, grey);
  EXPECT_EQ(grey(0, 0), 2040);  // 2048 / 4095 · 4080 = 2040.498
  to_grey(view, 0, grey);
  EXPECT_EQ(grey(0, 0), 128);  // 2048 / 65535 · 4080 = 127.5
  to_grey(view, 1000, grey);
  EXPECT_EQ(grey(0, 0), grey_max);  // brighter than white is white
}

TEST(Frame, ViewsNameTheirLayout) {
  const auto same = [](const FrameView& view, std::ptrdiff_t stride_bytes, SampleType sample, ChannelOrder order) {
    return view.width == 36 && view.height == 40 && view.stride_bytes == stride_bytes && view.sample == sample &&
           view.order == order;
  };
  const std::uint8_t bytes[1]{};
  const std::uint16_t words[1]{};
  using enum ChannelOrder;
  EXPECT_EQ(FrameView::grey8(bytes, 36, 40).data, bytes);
  EXPECT_TRUE(same(FrameView::grey8(bytes, 36, 40), 36, SampleType::u8, grey));
  EXPECT_TRUE(same(FrameView::grey8(bytes, 36, 40, 50), 50, SampleType::u8, grey));
  EXPECT_TRUE(same(FrameView::grey8(bytes, 36, 40, -50), -50, SampleType::u8, grey));
  EXPECT_TRUE(same(FrameView::grey16(words, 36, 40), 72, SampleType::u16, grey));
  EXPECT_TRUE(same(FrameView::bgr8(bytes, 36, 40), 108, SampleType::u8, bgr));
  EXPECT_TRUE(same(FrameView::bgr16(words, 36, 40), 216, SampleType::u16, bgr));
  EXPECT_TRUE(same(FrameView::rgb8(bytes, 36, 40), 108, SampleType::u8, rgb));
  EXPECT_TRUE(same(FrameView::rgb16(words, 36, 40, 300), 300, SampleType::u16, rgb));
  EXPECT_TRUE(same(FrameView::bgra8(bytes, 36, 40), 144, SampleType::u8, bgra));
  EXPECT_TRUE(same(FrameView::bgra16(words, 36, 40), 288, SampleType::u16, bgra));
  EXPECT_TRUE(same(FrameView::rgba8(bytes, 36, 40), 144, SampleType::u8, rgba));
  EXPECT_TRUE(same(FrameView::rgba16(words, 36, 40), 288, SampleType::u16, rgba));
}

TEST(Frame, RejectsBadSizesAndLevels) {
  const std::vector<std::uint8_t> data(100 * 100);
  GreyImage grey;
  EXPECT_THROW(to_grey({data.data(), 31, 40, 100, SampleType::u8, ChannelOrder::grey}, 0, grey), Error);
  EXPECT_THROW(to_grey({data.data(), 8193, 40, 8200, SampleType::u8, ChannelOrder::grey}, 0, grey), Error);
  EXPECT_THROW(to_grey({nullptr, 40, 40, 40, SampleType::u8, ChannelOrder::grey}, 0, grey), Error);
  EXPECT_THROW(to_grey({data.data(), 40, 40, 100, SampleType::u8, ChannelOrder::grey}, 300, grey), Error);
  EXPECT_THROW(to_grey({data.data(), 40, 40, 39, SampleType::u8, ChannelOrder::grey}, 0, grey), Error);
  EXPECT_THROW(to_grey({data.data(), 40, 40, 119, SampleType::u8, ChannelOrder::bgr}, 0, grey), Error);
  alignas(2) static const std::uint8_t samples[40 * 83]{};
  EXPECT_NO_THROW(to_grey({samples, 40, 40, 80, SampleType::u16, ChannelOrder::grey}, 0, grey));
  EXPECT_THROW(to_grey({samples, 40, 40, 81, SampleType::u16, ChannelOrder::grey}, 0, grey), Error);
  EXPECT_THROW(to_grey({samples + 1, 40, 40, 80, SampleType::u16, ChannelOrder::grey}, 0, grey), Error);
  EXPECT_NO_THROW(to_grey({samples + 39 * 80, 40, 40, -80, SampleType::u16, ChannelOrder::grey}, 0, grey));
}

TEST(Image, MovedImageIsEmpty) {
  Image<float> image(64, 32, 1.0F);
  const Image<float> other = std::move(image);
  EXPECT_EQ(other.width(), 64);
  EXPECT_EQ(other(63, 31), 1.0F);
  EXPECT_TRUE(image.empty());         // NOLINT(bugprone-use-after-move)
  EXPECT_TRUE(image.view().empty());  // NOLINT(bugprone-use-after-move)
  Image<float> assigned(3, 2);
  image.assign(16, 8, 2.0F);
  assigned = std::move(image);
  EXPECT_EQ(assigned.height(), 8);
  EXPECT_EQ(image.width(), 0);  // NOLINT(bugprone-use-after-move)
}

TEST(Image, KeepsMemoryWhenSizeComesBack) {
  Image<float> image(64, 32);
  const float* before = image.row(0);
  image.resize(16, 8);
  image.resize(64, 32);
  EXPECT_EQ(image.row(0), before);
}

}  // namespace
}  // namespace roadstereo
