// The white level of frames, changed while a pipeline runs: frames of 10 bits in 16.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "roadstereo/error.hpp"
#include "tests/damage/damage_checks.hpp"

namespace roadstereo {
namespace {

constexpr double ten_bit_white = 1023;

/// A view of 8 bits as a camera of 10 bits delivers it.
struct TenBitView {
  std::vector<std::uint16_t> samples;
  FrameView view;

  explicit TenBitView(const Frame& frame) {
    for (std::size_t k = 0; k < frame.bytes.size(); ++k) {
      samples.push_back(static_cast<std::uint16_t>(4 * frame.bytes[k] + k % 4));
    }
    view = FrameView::grey16(samples.data(), frame.width, frame.height);
  }

  GreyImage grey(double white_level) const {
    GreyImage image;
    to_grey(view, white_level, image);
    return image;
  }
};

struct TenBitPair {
  synth::SyntheticPair pair;
  TenBitView left, right;

  TenBitPair() : pair(synth::render(scene())), left(pair.left), right(pair.right) {}

 private:
  static synth::Scene scene() {
    synth::Scene scene = damaged_scene();
    scene.rig.width = 320;
    scene.rig.height = 180;
    scene.rig.focal_px = 300;
    return scene;
  }
};

PipelineOptions white_level_options(double level) {
  PipelineOptions options = preset("default");
  options.deblock = false;
  options.white_level = level;
  return options;
}

TEST(SetWhiteLevel, SameBitsAsOptionOfConstructor) {
  const TenBitPair frames;
  Pipeline made(white_level_options(ten_bit_white), frames.pair.calibration);
  Pipeline set(white_level_options(0), frames.pair.calibration);
  set.set_white_level(ten_bit_white);
  EXPECT_EQ(set.options().white_level, ten_bit_white);
  const FrameResult& expected = made.process(frames.left.view, frames.right.view);
  const FrameResult& result = set.process(frames.left.view, frames.right.view);
  ASSERT_TRUE(expected.roll_found);
  EXPECT_GT(expected.valid_share, 0.5);
  EXPECT_EQ(result.grey, expected.grey);
  EXPECT_EQ(result.right, expected.right);
  EXPECT_TRUE(equal_bits(result.disparity, expected.disparity));
  EXPECT_TRUE(equal_bits(result.sigma, expected.sigma));
  EXPECT_TRUE(equal_bits(result.transformed, expected.transformed));
  expect_same(made.find_damage(), set.find_damage());
}

TEST(SetWhiteLevel, HoldsFromNextFrame) {
  const TenBitPair frames;
  Pipeline pipeline(white_level_options(0), frames.pair.calibration);
  const FrameResult& result = pipeline.process(frames.left.view, frames.right.view);
  ASSERT_NE(frames.left.grey(0), frames.left.grey(ten_bit_white));
  EXPECT_EQ(result.grey, frames.left.grey(0));
  pipeline.set_white_level(ten_bit_white);
  EXPECT_EQ(result.grey, frames.left.grey(0)) << "the last frame is as it was";
  EXPECT_NO_THROW(pipeline.find_damage());
  for (int frame = 0; frame < 2; ++frame) {
    EXPECT_EQ(pipeline.process(frames.left.view, frames.right.view).grey, frames.left.grey(ten_bit_white)) << frame;
  }
  pipeline.set_white_level(0);
  EXPECT_EQ(pipeline.process(frames.left.view, frames.right.view).grey, frames.left.grey(0));
}

TEST(SetWhiteLevel, RefusedLevelChangesNothing) {
  const TenBitPair frames;
  Pipeline pipeline(white_level_options(ten_bit_white), frames.pair.calibration);
  for (const double level : {-1.0, 65536.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(pipeline.set_white_level(level), Error) << level;
    EXPECT_EQ(pipeline.options().white_level, ten_bit_white) << level;
  }
  EXPECT_EQ(pipeline.process(frames.left.view, frames.right.view).grey, frames.left.grey(ten_bit_white));
}

}  // namespace
}  // namespace roadstereo
