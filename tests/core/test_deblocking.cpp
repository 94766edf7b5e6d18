// Steps between the blocks of 8×8 pixels that JPEG leaves, measured and smoothed.

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

#include "core/deblocking.hpp"
#include "roadstereo/image.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

/// Texture of up to `texture` grey values and a level for each block of up to `step`.
GreyImage block_image(int width, int height, double texture, double step) {
  GreyImage image(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double level = 1000 + texture * test::lattice(u, v, 1) + step * test::lattice(u / 8, v / 8, 2);
      image(u, v) = static_cast<std::int16_t>(level);
    }
  }
  return image;
}

// |x − y| of two uniform numbers in [0, 1) is 1/3 on average.
TEST(Deblocking, MeasuresExcessOfSteps) {
  const GreyImage image = block_image(1600, 1200, 0, 300);
  const BlockSteps steps = measure_block_steps(image);
  EXPECT_EQ(steps.beside, 0);
  const BlockStepSamples samples(1600, 1200);
  EXPECT_EQ(samples.count(), 400 * 199 + 534 * 149);
  EXPECT_NEAR(static_cast<double>(steps.between) / samples.count(), 100, 3);
}

TEST(Deblocking, ImageWithoutBlocksStays) {
  for (const double texture : {0.0, 100.0, 3000.0}) {
    const GreyImage image = block_image(640, 360, texture, 0);
    const BlockSteps steps = measure_block_steps(image);
    EXPECT_NEAR(steps.excess(), 0, 0.025) << texture;
    EXPECT_EQ(deblocking_strength(steps, BlockStepSamples(640, 360).count()), 0) << texture;
  }
}

TEST(Deblocking, StrengthIsMeanExcess) {
  EXPECT_EQ(deblocking_strength({150'000, 200'000}, 1'000), 50);  // 150 between, 100 beside
  EXPECT_EQ(deblocking_strength({104'000, 200'000}, 1'000), 0);   // 4 %
  EXPECT_EQ(deblocking_strength({1'500, 2'000}, 10), 0);          // three standard errors of 10 steps are 95 %
}

/// A step of `height` between two blocks in the middle, smoothed with a strength of 20.
GreyImage smoothed_step(int height) {
  GreyImage image(16, 16);
  for (int v = 0; v < 16; ++v) {
    for (int u = 0; u < 16; ++u) image(u, v) = static_cast<std::int16_t>(u < 8 ? 1000 : 1000 + height);
  }
  smooth_block_steps(image, 20);
  return image;
}

// H.263, annex J: with a, b | c, d the step is (a − 4b + 4c − d)/8, and b and c move by it, up to the strength, and by
// less beyond that; a and d move by a quarter of their difference, up to half as far.
TEST(Deblocking, SmoothsStepsUpToTwiceTheStrength) {
  const GreyImage small = smoothed_step(40);  // 3/8 of it are 15
  EXPECT_EQ(small(5, 3), 1000);
  EXPECT_EQ(small(6, 3), 1007);
  EXPECT_EQ(small(7, 3), 1015);
  EXPECT_EQ(small(8, 3), 1025);
  EXPECT_EQ(small(9, 3), 1033);
  EXPECT_EQ(small(10, 3), 1040);
  const GreyImage larger = smoothed_step(80);  // 30: 2·20 − 30 are left of it
  EXPECT_EQ(larger(7, 3), 1010);
  EXPECT_EQ(larger(8, 3), 1070);
  const GreyImage edge = smoothed_step(120);  // 45 belong to the picture
  EXPECT_EQ(edge(7, 3), 1000);
  EXPECT_EQ(edge(8, 3), 1120);
}

TEST(Deblocking, BlocksFadeAndTextureStays) {
  GreyImage image = block_image(640, 360, 60, 60);
  const BlockSteps before = measure_block_steps(image);
  const int strength = deblocking_strength(before, BlockStepSamples(640, 360).count());
  ASSERT_GT(strength, 0);
  smooth_block_steps(image, strength);
  EXPECT_LT(measure_block_steps(image).excess(), 0.75 * before.excess());
  EXPECT_EQ(image(3, 3), block_image(640, 360, 60, 60)(3, 3));
}

TEST(Deblocking, SmallestImages) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {40, 1}, {9, 9}, {10, 10}}) {
    GreyImage image = block_image(width, height, 50, 500);
    (void)measure_block_steps(image);
    smooth_block_steps(image, 100);
    EXPECT_EQ(image.width(), width);
  }
}

}  // namespace
}  // namespace roadstereo
