// What stands beside a road and before the lens, against closed forms.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "tests/synth/rendered_scenes.hpp"

namespace roadstereo::synth {
namespace {

std::size_t count_of(const Image<std::uint8_t>& map, std::uint8_t value) {
  return static_cast<std::size_t>(std::count(map.row(0), map.row(0) + map.pixels(), value));
}

TEST(SceneBox, FrontFaceHasDepthOfItsPlane) {
  Scene scene = bare_scene(0, 0);
  Box box;
  box.x_m = 0.5;
  box.y_m = 7;
  box.length_m = 4;  // the face is 5 m ahead
  box.width_m = 2;
  box.top_m = 1.2;
  scene.road.boxes = {box};
  const SyntheticPair pair = render(scene);
  // f = 100, h = 1.5: the face spans X −0.5 … 1.5 and Z 0 … 1.2, that is columns 53.5 … 93.5 and rows 53.5 … 77.5.
  EXPECT_NEAR(pair.disparity(70, 60), 100 * 0.12 / 5, 1e-12);
  EXPECT_NEAR(pair.disparity(54, 77), 100 * 0.12 / 5, 1e-12);
  EXPECT_NEAR(pair.disparity(54, 78), 100 * 0.12 * (78 - 47.5) / 100 / 1.5, 1e-12);
  EXPECT_EQ(pair.road(70, 60), 0);
  EXPECT_EQ(pair.road(54, 78), 255);
  // The right camera, 0.12 m to the right, sees less of the road left of the box, and none of what the box hides.
  EXPECT_EQ(pair.visible(53, 60), 0);
  EXPECT_EQ(pair.visible(70, 60), 255);
}

TEST(SceneCrest, DisparityFollowsParabola) {
  Scene scene = bare_scene(90, 0);
  scene.road.crest = 0.05;
  const SyntheticPair pair = render(scene);
  for (const int v : {0, 20, 47, 95}) {
    // Straight down, h = 1.5: y = Z·t with t = (47.5 − v)/100 and Z = 1.5 + 0.05·y².
    const double t = (47.5 - v) / 100;
    const double depth = t == 0 ? 1.5 : (1 - std::sqrt(1 - 4 * 0.05 * 1.5 * t * t)) / (2 * 0.05 * t * t);
    EXPECT_NEAR(pair.disparity(30, v), 100 * 0.12 / depth, 1e-9);
  }
}

TEST(PhotonNoise, VarianceIsProportionalToSignal) {
  Scene scene = small_scene("flat");
  const SyntheticPair clean = render(scene);
  scene.degradation.full_well_electrons = 400;
  const SyntheticPair noisy = render(scene);
  double squares = 0;
  for (std::size_t i = 0; i < clean.left.bytes.size(); ++i) {
    const double difference = double{1} * noisy.left.bytes[i] - clean.left.bytes[i];
    squares += difference * difference;
  }
  const double expected = mean_grey(clean.left) * 255 / 400;
  EXPECT_NEAR(squares / static_cast<double>(clean.left.bytes.size()), expected, 0.05 * expected);
}

TEST(RowRotation, TurnsRightImageAboutItsCentre) {
  Scene scene = small_scene("flat");
  const SyntheticPair straight = render(scene);
  scene.degradation.row_rotation_deg = 5;
  const SyntheticPair turned = render(scene);
  EXPECT_EQ(straight.left.bytes, turned.left.bytes);
  EXPECT_EQ(straight.disparity, turned.disparity);
  const double angle = 5 * std::numbers::pi / 180;
  const double cu = (scene.rig.width - 1) / 2.0, cv = (scene.rig.height - 1) / 2.0;
  double squares = 0, still = 0;
  int count = 0;
  for (int v = 20; v < scene.rig.height - 20; ++v) {
    for (int u = 30; u < scene.rig.width - 30; ++u) {
      // Clockwise in the picture: a point right of the centre moves down.
      const double du = u - cu, dv = v - cv;
      const double at_u = cu + std::cos(angle) * du - std::sin(angle) * dv;
      const double at_v = cv + std::sin(angle) * du + std::cos(angle) * dv;
      const int row = static_cast<int>(std::floor(at_v));
      const double seen = cubic_sample(turned.right, at_u, row) * (row + 1 - at_v) +
                          cubic_sample(turned.right, at_u, row + 1) * (at_v - row);
      squares += std::pow(seen - grey(straight.right, u, v), 2);
      still += std::pow(grey(turned.right, u, v) - grey(straight.right, u, v), 2);
      ++count;
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.6 * std::sqrt(still / count));
}

TEST(Bonnet, HidesLowerBorderWithoutTruth) {
  Scene scene = bare_scene(60, 0);
  scene.degradation.bonnet_share = 0.25;
  const SyntheticPair pair = render(scene);
  EXPECT_TRUE(std::isnan(pair.disparity(64, 95)));
  EXPECT_TRUE(std::isnan(pair.disparity(64, 73)));
  EXPECT_FALSE(std::isnan(pair.disparity(64, 70)));
  EXPECT_EQ(pair.visible(64, 95), 0);
  EXPECT_EQ(pair.road(64, 95), 0);
}

TEST(Snow, IsSeenByOneCameraOnly) {
  Scene scene = bare_scene(60, 0);
  const SyntheticPair clean = render(scene);
  scene.degradation.snowflakes = 20;
  const SyntheticPair snow = render(scene);
  EXPECT_EQ(clean.disparity, snow.disparity);
  int left = 0, both = 0;
  for (std::size_t i = 0; i < clean.left.bytes.size(); ++i) {
    const bool in_left = clean.left.bytes[i] != snow.left.bytes[i];
    left += in_left ? 1 : 0;
    both += in_left && clean.right.bytes[i] != snow.right.bytes[i] ? 1 : 0;
  }
  EXPECT_GE(left, 20);
  EXPECT_LT(both, left / 4);
}

TEST(Scenery, IsNoDamage) {
  Scene scene = bare_scene(90, 0);
  scene.road.blobs = {{-0.3, 0, 0.2, 0.05, 0.2, 0.25, 1}, {0.3, 0, 0.2, -0.1, 0.2, 0.5, 2, false}};
  const SyntheticPair pair = render(scene);
  ASSERT_EQ(pair.damages.size(), 1U);
  EXPECT_EQ(pair.damages[0].id, 1);
  EXPECT_EQ(*std::max_element(pair.labels.row(0), pair.labels.row(0) + pair.labels.pixels()), 1);
  EXPECT_EQ(pair.road(83, 47), 0);
  EXPECT_EQ(pair.road(44, 47), 255);
  EXPECT_LT(count_of(pair.road, 0), pair.road.pixels() / 10);
}

TEST(RandomWideScene, IsValidAndRepeatable) {
  int streets = 0, bonnets = 0, boxes = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Scene scene = random_wide_scene(seed);
    ASSERT_NO_THROW(scene.validate()) << "seed " << seed;
    const Scene again = random_wide_scene(seed);
    EXPECT_EQ(scene.rig.focal_px, again.rig.focal_px);
    EXPECT_EQ(scene.road.boxes.size(), again.road.boxes.size());
    streets += scene.rig.pitch_deg < 20 ? 1 : 0;
    bonnets += scene.degradation.bonnet_share > 0 ? 1 : 0;
    boxes += static_cast<int>(scene.road.boxes.size());
  }
  EXPECT_GT(streets, 70);
  EXPECT_GT(bonnets, 5);
  EXPECT_GT(boxes, 200);
}

}  // namespace
}  // namespace roadstereo::synth
