// Disparities, labels and visibility that come with a rendered pair, against closed forms and the pictures themselves.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "tests/synth/rendered_scenes.hpp"

namespace roadstereo::synth {
namespace {

/// Shift of least RMS difference: what a perfect matcher would find wrong with the truth.
double best_shift(const SyntheticPair& pair) {
  constexpr double h = 0.1;
  const auto energy = [&](double shift) { return std::pow(warp_rms(pair, shift), 2); };
  const double below = energy(-h);
  const double here = energy(0);
  const double above = energy(h);
  return h * 0.5 * (below - above) / (below - 2 * here + above);
}

TEST(RenderTruth, FrontoParallelPlaneHasOneDisparity) {
  const Scene scene = bare_scene(90, 0);
  const SyntheticPair pair = render(scene);
  const double expected = 100 * 0.12 / 1.5;
  for (int v = 0; v < 96; ++v) {
    for (int u = 0; u < 128; ++u) ASSERT_NEAR(pair.disparity(u, v), expected, 1e-9);
  }
  EXPECT_EQ(pair.plane.a1, 0);
  EXPECT_EQ(pair.plane.a2, 0);
  EXPECT_EQ(pair.roll_rad, 0);
}

TEST(RenderTruth, PlaneDisparityFollowsHomography) {
  for (const auto& [pitch, roll] : {std::pair{60.0, 0.0}, {60.0, 8.0}, {35.0, -5.0}, {80.0, 20.0}}) {
    const SyntheticPair pair = render(bare_scene(pitch, roll));
    // The plane n·P = h in the camera's frame, n pointing down: undo the roll, then the pitch.
    const double p = pitch * std::numbers::pi / 180;
    const double r = roll * std::numbers::pi / 180;
    const std::array<double, 3> n{-std::sin(r) * std::cos(p), std::cos(r) * std::cos(p), std::sin(p)};
    for (int v = 0; v < 96; ++v) {
      for (int u = 0; u < 128; ++u) {
        const double x = (u - 63.5) / 100;
        const double y = (v - 47.5) / 100;
        const double inverse_depth = (n[0] * x + n[1] * y + n[2]) / 1.5;
        if (inverse_depth < 1e-2) continue;
        ASSERT_NEAR(pair.disparity(u, v), 100 * 0.12 * inverse_depth, 1e-9);
        ASSERT_NEAR(pair.plane.disparity(u, v), pair.disparity(u, v), 1e-9);
      }
    }
    EXPECT_NEAR(pair.roll_rad, r, 1e-12);
    EXPECT_NEAR(pair.roll_rad, std::atan(-pair.plane.a2 / pair.plane.a1), 1e-15);
  }
}

TEST(RenderTruth, PlaneIsIndependentOfPosition) {
  Scene scene = bare_scene(50, 3);
  const SyntheticPair here = render(scene);
  scene.rig.x_m = 12;
  scene.rig.y_m = 345;
  const SyntheticPair there = render(scene);
  EXPECT_NEAR(here.disparity(5, 90), there.disparity(5, 90), 1e-12);
  EXPECT_NE(here.left.bytes, there.left.bytes);
}

TEST(RenderTruth, CamberAndKerbFollowFormula) {
  Scene scene = bare_scene(60, 4);
  scene.road.camber = 0.02;
  scene.road.kerbs = {{0.3, 0.1, 0.02}};
  const SyntheticPair pair = render(scene);
  const double p = 60 * std::numbers::pi / 180;
  const double r = 4 * std::numbers::pi / 180;
  for (int v = 0; v < 96; v += 5) {
    for (int u = 0; u < 128; u += 5) {
      const auto [x, y, z] = pair.calibration.point_m(u, v, pair.disparity(u, v));
      // Back to the road: undo the roll, then the pitch.
      const double level_x = std::cos(r) * x + std::sin(r) * y;
      const double level_y = -std::sin(r) * x + std::cos(r) * y;
      const double road_z = 1.5 - std::cos(p) * level_y - std::sin(p) * z;
      const double kerb = 0.1 * std::clamp((level_x - 0.3) / 0.02, 0.0, 1.0);
      EXPECT_NEAR(road_z, kerb - 0.02 * level_x * level_x, 1e-12) << u << ' ' << v;
    }
  }
}

TEST(RenderTruth, DisparityLiesOnBlob) {
  Scene scene = bare_scene(90, 0);
  scene.road.blobs = {{0.2, 0.1, 0.4, 0.1, 0, 0.25, 1}};
  const SyntheticPair pair = render(scene);
  int on_wall = 0;
  for (int v = 0; v < 96; ++v) {
    for (int u = 0; u < 128; ++u) {
      const auto [x, y, z] = pair.calibration.point_m(u, v, pair.disparity(u, v));
      const double q = std::clamp((1 - std::hypot(x - 0.2, -y - 0.1) / 0.4) / 0.25, 0.0, 1.0);
      ASSERT_NEAR(z, 1.5 + 0.1 * q * q * (3 - 2 * q), 2e-12);
      ASSERT_EQ(pair.labels(u, v), q > 0 ? 1 : 0);
      on_wall += q > 0 && q < 1 ? 1 : 0;
    }
  }
  EXPECT_GT(on_wall, 100);
}

TEST(RenderTruth, WarpsRightOntoLeft) {
  for (const char* name : {"flat", "rolled", "nadir", "close", "street"}) {
    Scene scene = small_scene(name);
    scene.rig.width *= 2;
    scene.rig.height *= 2;
    scene.rig.focal_px *= 2;
    scene.supersampling = 3;
    const SyntheticPair pair = render(scene);
    const double exact = warp_rms(pair, 0);
    EXPECT_LT(exact, 2.5) << name;
    EXPECT_GT(warp_rms(pair, 1), 3.5 * exact) << name;
    EXPECT_GT(warp_rms(pair, -1), 3.5 * exact) << name;
    // Straight down all pixels share one fraction, and with it the error of the cubic interpolation.
    EXPECT_NEAR(best_shift(pair), 0, name == std::string("nadir") ? 0.02 : 0.005) << name;
  }
}

TEST(RenderTruth, OccludedPixelsAreInvisible) {
  Scene scene = bare_scene(90, 0);
  scene.rig.baseline_m = 0.5;
  scene.rig.focal_px = 60;
  // A steep wall: the right camera does not see what lies left of it.
  scene.road.blobs = {{0.3, 0, 0.3, -0.4, 0, 0.05, 1}};
  const SyntheticPair pair = render(scene);
  int hidden = 0;
  for (int u = 0; u < 128; ++u) {
    const auto [x, y, z] = pair.calibration.point_m(u, 47, pair.disparity(u, 47));
    const double target = u - pair.disparity(u, 47);
    if (target < 0) {
      EXPECT_EQ(pair.visible(u, 47), 0) << u;
      continue;
    }
    if (pair.labels(u, 47) != 0 || std::abs(x) > 1.2) continue;
    // The ground's line of sight to the right camera at (0.5, 1.5 m up) passes the top, 0.4 m high, out to x
    // = 0.585.
    const double at_top = x + (0.5 - x) * 0.4 / 1.5;
    const bool blocked = at_top > 0.02 && at_top < 0.58;
    const bool free = at_top < -0.01 || at_top > 0.61;
    if (blocked) {
      EXPECT_EQ(pair.visible(u, 47), 0) << u << " x " << x;
      ++hidden;
    }
    if (free) {
      EXPECT_EQ(pair.visible(u, 47), 255) << u << " x " << x;
    }
  }
  EXPECT_GE(hidden, 3);
  EXPECT_EQ(pair.visible(2, 5), 0) << "the left border is outside the right image";
}

TEST(RenderTruth, SkyHasNoDisparity) {
  const SyntheticPair pair = render(small_scene("street"));
  EXPECT_TRUE(std::isnan(pair.disparity(100, 0)));
  EXPECT_EQ(pair.visible(100, 0), 0);
  EXPECT_FALSE(std::isnan(pair.disparity(100, pair.left.height - 1)));
}

TEST(RenderTruth, IsIndependentOfThreads) {
  Scene scene = random_scene(5, true);
  scene.rig.width = 160;
  scene.rig.height = 96;
  scene.rig.focal_px = 90;
  scene.degradation.noise_grey = 3;
  scene.degradation.blur_px = 0.7;
  scene.degradation.motion_blur_px = 2;
  const SyntheticPair one = render(scene, 1);
  for (const int threads : {1, 2, 5}) {
    const SyntheticPair other = render(scene, threads);
    EXPECT_EQ(one.left.bytes, other.left.bytes);
    EXPECT_EQ(one.right.bytes, other.right.bytes);
    EXPECT_EQ(one.labels, other.labels);
    EXPECT_EQ(one.visible, other.visible);
    for (int v = 0; v < 96; ++v) {
      for (int u = 0; u < 160; ++u) {
        const double a = one.disparity(u, v);
        const double b = other.disparity(u, v);
        ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b)));
      }
    }
  }
}

}  // namespace
}  // namespace roadstereo::synth
