// What degradations do to the pictures.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tests/synth/rendered_scenes.hpp"

namespace roadstereo::synth {
namespace {

TEST(Degradation, RowOffsetMovesRightImageDown) {
  Scene scene = small_scene("uav");
  const SyntheticPair straight = render(scene);
  scene.degradation.row_offset_px = 2;
  const SyntheticPair moved = render(scene);
  EXPECT_EQ(straight.left.bytes, moved.left.bytes);
  EXPECT_EQ(straight.disparity, moved.disparity);
  // A whole number of rows: the same rays, but for the last digits of their rows.
  double worst = 0;
  for (int v = 2; v < scene.rig.height; ++v) {
    for (int u = 0; u < scene.rig.width; ++u) {
      const double difference = std::abs(grey(moved.right, u, v) - grey(straight.right, u, v - 2));
      if (std::isnan(difference) || difference > worst) worst = difference;
    }
  }
  EXPECT_LE(worst, 1);
  EXPECT_EQ(moved.visible(scene.rig.width / 2, scene.rig.height - 1), 0);
}

TEST(Degradation, NoiseHasDeviationAndSeed) {
  Scene scene = small_scene("flat");
  const SyntheticPair clean = render(scene);
  scene.degradation.noise_grey = 6;
  const SyntheticPair noisy = render(scene);
  double sum = 0;
  double squares = 0;
  double product = 0;
  const auto n = static_cast<double>(clean.left.bytes.size());
  for (std::size_t i = 0; i < clean.left.bytes.size(); ++i) {
    const double left = double{1} * noisy.left.bytes[i] - clean.left.bytes[i];
    const double right = double{1} * noisy.right.bytes[i] - clean.right.bytes[i];
    sum += left;
    squares += left * left;
    product += left * right;
  }
  EXPECT_NEAR(sum / n, 0, 0.2);
  EXPECT_NEAR(std::sqrt(squares / n), 6, 0.2);
  EXPECT_NEAR(product / n, 0, 1.5) << "the two cameras' noise is independent";
  scene.degradation.noise_seed = 2;
  EXPECT_NE(render(scene).left.bytes, noisy.left.bytes);
}

TEST(Degradation, GainAndExposureScaleImages) {
  Scene scene = small_scene("flat");
  const SyntheticPair clean = render(scene);
  scene.degradation.gain_difference = 0.15;
  const SyntheticPair uneven = render(scene);
  EXPECT_EQ(clean.left.bytes, uneven.left.bytes);
  EXPECT_NEAR(mean_grey(uneven.right) / mean_grey(clean.right), 1.15, 0.003);
  scene.degradation.gain_difference = 0;
  scene.degradation.exposure = 0.5;
  EXPECT_NEAR(mean_grey(render(scene).left) / mean_grey(clean.left), 0.5, 0.003);
  scene.degradation.exposure = 10;
  EXPECT_EQ(mean_grey(render(scene).left), 255);
}

TEST(Degradation, BlurKeepsMeanAndReducesContrast) {
  const auto variation = [](const Frame& frame) {
    double sum = 0;
    for (int v = 1; v < frame.height; ++v) {
      for (int u = 1; u < frame.width; ++u) {
        sum += std::pow(grey(frame, u, v) - grey(frame, u - 1, v), 2) +
               std::pow(grey(frame, u, v) - grey(frame, u, v - 1), 2);
      }
    }
    return sum;
  };
  Scene scene = small_scene("flat");
  const Frame clean = render(scene).left;
  scene.degradation.blur_px = 1.5;
  const Frame blurred = render(scene).left;
  EXPECT_NEAR(mean_grey(blurred), mean_grey(clean), 0.5);
  EXPECT_LT(variation(blurred), 0.25 * variation(clean));
  scene.degradation.blur_px = 0;
  scene.degradation.motion_blur_px = 5;
  const Frame moved = render(scene).left;
  EXPECT_NEAR(mean_grey(moved), mean_grey(clean), 0.5);
  EXPECT_LT(variation(moved), 0.7 * variation(clean));
}

}  // namespace
}  // namespace roadstereo::synth
