// Camera frames to grey levels on the device, and smaller images of them: the same bits as on the host.

#include "core/cuda/device_frame.hpp"
#include "core/cuda/downsample.hpp"
#include "core/cuda/grey.hpp"
#include "core/downsample.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

constexpr int width = 129, height = 47;

class CudaGrey : public test::OnDevice {};
class CudaShrink : public test::OnDevice {};

/// A frame of random samples whose rows lie further apart than they are long.
struct RandomFrame {
  std::vector<std::uint8_t> bytes;
  FrameView view;

  RandomFrame(SampleType sample, ChannelOrder order, std::uint64_t seed) {
    const std::ptrdiff_t sample_bytes = sample == SampleType::u16 ? 2 : 1;
    view = {nullptr, width, height, sample_bytes * (channel_count(order) * width + 5), sample, order};
    bytes.resize(static_cast<std::size_t>(view.stride_bytes * height));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      bytes[i] = static_cast<std::uint8_t>(256 * test::lattice(static_cast<std::int64_t>(i), 0, seed));
    }
    view.data = bytes.data();
  }
};

/// Both grey images and what was found, of one converter.
struct Converted {
  GreyImage left, right;
  cuda::PairFindings findings;
};

Converted convert(cuda::PairToGrey& converter, const RandomFrame& left, const RandomFrame& right,
                  double white_level = 0) {
  const auto left_bytes = test::to_device(left.bytes), right_bytes = test::to_device(right.bytes);
  const test::DevicePlane<std::int16_t> left_grey(width, height), right_grey(width, height);
  converter.convert(cuda::device_frame(left.view, left_bytes.data(), white_level),
                    cuda::device_frame(right.view, right_bytes.data(), white_level), left_grey.plane(),
                    right_grey.plane(), nullptr);
  return {left_grey.on_host(), right_grey.on_host(), converter.findings()};
}

TEST_F(CudaGrey, EveryFrameFormatMatchesHost) {
  cuda::PairToGrey converter;
  for (const SampleType sample : {SampleType::u8, SampleType::u16}) {
    for (const ChannelOrder order :
         {ChannelOrder::grey, ChannelOrder::bgr, ChannelOrder::rgb, ChannelOrder::bgra, ChannelOrder::rgba}) {
      const RandomFrame left(sample, order, 1), right(SampleType::u8, ChannelOrder::bgr, 2);
      const Converted found = convert(converter, left, right, 200);
      GreyImage left_grey, right_grey;
      to_grey(left.view, 200, left_grey);
      to_grey(right.view, 200, right_grey);
      EXPECT_EQ(found.left, left_grey);
      EXPECT_EQ(found.right, right_grey);
      EXPECT_EQ(found.findings.left_level, left_grey(0, 0));
      EXPECT_EQ(found.findings.right_level, right_grey(0, 0));
    }
  }
}

TEST_F(CudaGrey, WhiteIsLargestSampleUnlessGiven) {
  cuda::PairToGrey converter;
  const RandomFrame frame(SampleType::u16, ChannelOrder::rgba, 3);
  for (const double white_level : {0.0, 4095.0}) {
    GreyImage grey;
    to_grey(frame.view, white_level, grey);
    EXPECT_EQ(convert(converter, frame, frame, white_level).left, grey);
  }
}

TEST_F(CudaGrey, DetectsSingleDifferentPixel) {
  cuda::PairToGrey converter;
  RandomFrame left(SampleType::u8, ChannelOrder::grey, 4);
  std::fill(left.bytes.begin(), left.bytes.end(), std::uint8_t{77});
  RandomFrame right = left;
  right.view.data = right.bytes.data();
  const auto found = [&] { return convert(converter, left, right).findings; };
  cuda::PairFindings findings = found();
  EXPECT_FALSE(findings.left_varies || findings.right_varies || findings.differ);
  EXPECT_EQ(findings.left_level, 77 * grey_scale);
  right.bytes.back() = 78;  // behind the end of the last row
  findings = found();
  EXPECT_FALSE(findings.left_varies || findings.right_varies || findings.differ);
  const auto last = static_cast<std::size_t>((height - 1) * right.view.stride_bytes + width - 1);
  right.bytes[last] = 78;
  findings = found();
  EXPECT_TRUE(!findings.left_varies && findings.right_varies && findings.differ);
  left.bytes[last] = 78;
  findings = found();
  EXPECT_TRUE(findings.left_varies && findings.right_varies && !findings.differ);
  left.bytes[0] = right.bytes[0] = 78;
  left.bytes[1] = 79;
  right = left;
  right.view.data = right.bytes.data();
  findings = found();
  EXPECT_TRUE(findings.left_varies && findings.right_varies && !findings.differ);
}

TEST_F(CudaShrink, MatchesHost) {
  const auto pair = test::textured_pair(width, height, [](double, double) { return 3; });
  const test::DevicePlane<std::int16_t> first(pair.reference), second(pair.target);
  for (const int factor : {1, 2, 3, 4, 8}) {
    SCOPED_TRACE(factor);
    const test::DevicePlane<std::int16_t> small(width / factor, height / factor);
    const test::DevicePlane<std::int16_t> a(width / factor, height / factor), b(width / factor, height / factor);
    cuda::downsample(first.view(), factor, small.plane(), nullptr);
    cuda::downsample(first.view(), second.view(), factor, a.plane(), b.plane(), nullptr);
    EXPECT_EQ(small.on_host(), downsample(pair.reference, factor));
    EXPECT_EQ(a.on_host(), downsample(pair.reference, factor));
    EXPECT_EQ(b.on_host(), downsample(pair.target, factor));
  }
}

}  // namespace
}  // namespace roadstereo
