// Figures of rendered damage against integrals.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/synth/rendered_scenes.hpp"

namespace roadstereo::synth {
namespace {

TEST(DamageTruth, BlobMatchesIntegral) {
  for (const double wall : {0.1, 0.4, 1.0}) {
    Scene scene = bare_scene(70, 0);
    scene.road.blobs = {{0.1, 0.5, 0.3, 0.08, 0, wall, 1}, {-0.6, 0.9, 0.2, -0.03, 0, wall, 2}};
    const SyntheticPair pair = render(scene);
    ASSERT_EQ(pair.damages.size(), 2u);
    const double disc = std::numbers::pi * 0.3 * 0.3;
    // ∫ of the cubic wall over the disc: π R² h (1 − w + 0.3 w²).
    const double volume = disc * 0.08 * (1 - wall + 0.3 * wall * wall);
    EXPECT_EQ(pair.damages[0].kind, "pothole");
    EXPECT_EQ(pair.damages[0].id, 1);
    EXPECT_NEAR(pair.damages[0].area_m2, disc, 1e-3 * disc);
    EXPECT_NEAR(pair.damages[0].volume_m3, volume, 1e-4 * volume);
    EXPECT_NEAR(pair.damages[0].mean_depth_m, volume / disc, 2e-3 * volume / disc);
    EXPECT_NEAR(pair.damages[0].depth_m, 0.08, 1e-5);
    EXPECT_NEAR(pair.damages[0].x_m, 0.1, 1e-4);
    EXPECT_NEAR(pair.damages[0].y_m, 0.5, 1e-4);
    EXPECT_EQ(pair.damages[1].kind, "bump");
    EXPECT_NEAR(pair.damages[1].depth_m, 0.03, 1e-5);
  }
}

TEST(DamageTruth, CrackMatchesIntegral) {
  Scene scene = bare_scene(70, 0);
  scene.road.cracks = {{{{-0.3, 0.3}, {0.4, 0.8}}, 0.02, 0.03}};
  const SyntheticPair pair = render(scene);
  ASSERT_EQ(pair.damages.size(), 1u);
  const double length = std::hypot(0.7, 0.5);
  const double cap = std::numbers::pi * 0.01 * 0.01;
  const double area = length * 0.02 + cap;
  const double volume = length * 0.02 * 0.03 / 2 + cap * 0.03 / 3;
  EXPECT_EQ(pair.damages[0].kind, "crack");
  EXPECT_NEAR(pair.damages[0].area_m2, area, 5e-3 * area);
  EXPECT_NEAR(pair.damages[0].volume_m3, volume, 5e-3 * volume);
  EXPECT_NEAR(pair.damages[0].depth_m, 0.03, 1e-3);
}

TEST(DamageTruth, RutMatchesIntegral) {
  Scene scene = bare_scene(70, 0);
  scene.road.ruts = {{{-0.2, -3}, {0.4, 9}, 0.6, 0.02}};
  const SyntheticPair pair = render(scene);
  ASSERT_EQ(pair.damages.size(), 1u);
  const double length = std::hypot(0.6, 12);
  // A section of 2/3 of width times depth; smoothsteps over the width at both ends take half of it each.
  const double area = length * 0.6, volume = 2.0 / 3 * 0.6 * 0.02 * (length - 0.6);
  EXPECT_EQ(pair.damages[0].kind, "rut");
  EXPECT_NEAR(pair.damages[0].area_m2, area, 5e-3 * area);
  EXPECT_NEAR(pair.damages[0].volume_m3, volume, 5e-3 * volume);
  EXPECT_NEAR(pair.damages[0].depth_m, 0.02, 1e-4);
  EXPECT_NEAR(pair.damages[0].x_m, 0.1, 5e-3);
  EXPECT_NEAR(pair.damages[0].y_m, 3, 5e-3);
}

}  // namespace
}  // namespace roadstereo::synth
