// Where a block lies in the other image, against an analytic texture under a known warp, by every instruction set.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "road/block_alignment.hpp"
#include "tests/core/every_target.hpp"

namespace roadstereo {
namespace {

using AlignBlockTarget = test::EveryTarget;

constexpr int width = 80, height = 60;
constexpr int centre_u = 45, centre_v = 30;
constexpr int radius = 8;

/// 8-bit grey level between and on the pixels; its features are so wide that linear interpolation is exact enough.
double texture(double u, double v) {
  return 120 + 30 * std::sin(0.31 * u + 0.17 * v) + 25 * std::sin(0.12 * u - 0.35 * v + 1) +
         20 * std::sin(0.22 * u + 0.27 * v + 2);
}

GreyImage paint(const std::function<double(double, double)>& grey) {
  GreyImage image(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) image(u, v) = static_cast<std::int16_t>(std::lround(grey(u, v) * grey_scale));
  }
  return image;
}

/// The right image: the point (x, y) around the centre of the left one is seen at x' = x + du + shear·y + stretch·x,
/// y' = y + dv, with another gain and offset.
GreyImage warped(const BlockAlignment& truth, double gain, double offset) {
  return paint([&](double u, double v) {
    const double y = v - centre_v - truth.dv;
    const double x = (u - centre_u - truth.du - truth.shear * y) / (1 + truth.stretch);
    return gain * texture(centre_u + x, centre_v + y) + offset;
  });
}

TEST_P(AlignBlockTarget, RecoversKnownWarp) {
  const GreyImage left = paint(texture);
  constexpr BlockAlignment warps[] = {{0, 0, 0, 0},          {-7.4, 0.3, 0, 0},       {-7.4, 0.3, 0.1, 0},
                                      {-6.8, -0.6, 0, 0.05}, {-7.3, 0.5, -0.15, 0.1}, {-8, 1, 0.2, -0.08}};
  for (const BlockAlignment& truth : warps) {
    for (const double gain : {1.0, 0.7}) {
      SCOPED_TRACE(testing::Message() << truth.du << ", " << truth.dv << ", gain " << gain);
      const GreyImage right = warped(truth, gain, 15);
      const BlockAlignment start{.du = std::round(truth.du), .dv = std::round(truth.dv)};
      const auto found = affine_lucas_kanade(left, centre_u, centre_v, right, start, radius);
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->du, truth.du, 0.02);
      EXPECT_NEAR(found->dv, truth.dv, 0.02);
      EXPECT_NEAR(found->shear, truth.shear, 0.005);
      EXPECT_NEAR(found->stretch, truth.stretch, 0.005);
    }
  }
}

/// The noise of a row is in its residual, and must not be in its slope. 48 blocks of 40 pairs have a standard error of
/// 0.005 px; a difference of two rows as the slope is off by 0.06 px.
TEST_P(AlignBlockTarget, NoiseDoesNotMoveRows) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 8);
  double sum = 0;
  int count = 0;
  for (int pair = 0; pair < 40; ++pair) {
    const auto noisy = [&](double u, double v) { return texture(u + 97 * pair, v) + noise(random); };
    const GreyImage left = paint(noisy), right = paint(noisy);
    for (int v = radius + 3; v + radius + 3 < height; v += 8) {
      for (int u = radius + 3; u + radius + 3 < width; u += 8) {
        const auto found = affine_lucas_kanade(left, u, v, right, {}, radius);
        if (!found) continue;
        sum += found->dv;
        ++count;
      }
    }
  }
  ASSERT_GT(count, 200);
  EXPECT_NEAR(sum / count, 0, 0.02);
}

TEST_P(AlignBlockTarget, FailsWithoutTexture) {
  const GreyImage flat(width, height, 1600);
  EXPECT_FALSE(affine_lucas_kanade(flat, centre_u, centre_v, flat, {}, radius));
  // Texture along the rows alone does not tell the vertical offset.
  const GreyImage stripes = paint([](double u, double) { return 120 + 50 * std::sin(0.4 * u); });
  EXPECT_FALSE(affine_lucas_kanade(stripes, centre_u, centre_v, stripes, {}, radius));
}

TEST_P(AlignBlockTarget, FailsBeyondImages) {
  const GreyImage image = paint(texture);
  EXPECT_TRUE(affine_lucas_kanade(image, radius + 2, radius + 2, image, {}, radius));
  EXPECT_FALSE(affine_lucas_kanade(image, radius - 1, centre_v, image, {}, radius));
  EXPECT_FALSE(affine_lucas_kanade(image, width - radius, centre_v, image, {}, radius));
  EXPECT_FALSE(affine_lucas_kanade(image, centre_u, radius - 1, image, {}, radius));
  EXPECT_FALSE(affine_lucas_kanade(image, centre_u, height - radius, image, {}, radius));
  EXPECT_FALSE(affine_lucas_kanade(image, radius + 2, centre_v, image, {.du = -3}, radius));
}

TEST_P(AlignBlockTarget, FailsWhereStretchedByMoreThanHalf) {
  const GreyImage left = paint(texture);
  const auto is_found = [&](double stretch) {
    const BlockAlignment truth{.du = -3, .stretch = stretch};
    return affine_lucas_kanade(left, centre_u, centre_v, warped(truth, 1, 0), truth, radius).has_value();
  };
  EXPECT_TRUE(is_found(0.4));
  EXPECT_TRUE(is_found(-0.4));
  EXPECT_FALSE(is_found(0.6));
}

TEST_P(AlignBlockTarget, FailsFarFromStart) {
  const GreyImage left = paint(texture), right = warped({.du = -7}, 1, 0);
  EXPECT_FALSE(affine_lucas_kanade(left, centre_u, centre_v, right, {.du = -5}, radius));
}

TEST_P(AlignBlockTarget, FailsWithoutCorrelation) {
  const GreyImage left = paint(texture);
  const GreyImage negative = paint([](double u, double v) { return 240 - texture(u, v); });
  EXPECT_FALSE(affine_lucas_kanade(left, centre_u, centre_v, negative, {}, radius));
}

INSTANTIATE_TEST_SUITE_P(Machine, AlignBlockTarget, testing::ValuesIn(test::targets_of_this_machine()),
                         test::name_of_target);

}  // namespace
}  // namespace roadstereo
