// Damages, and what is no damage, whose outlines touch.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "roadstereo/damage.hpp"
#include "tests/damage/damage_checks.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

/// Mean over a square window, as the support of matching smears depths over rims.
void smear(Image<float>& map, int radius) {
  const Image<float> sharp = map;
  for (int v = radius; v + radius < map.height(); ++v) {
    for (int u = radius; u + radius < map.width(); ++u) {
      double sum = 0;
      for (int y = v - radius; y <= v + radius; ++y) {
        for (int x = u - radius; x <= u + radius; ++x) sum += sharp(x, y);
      }
      map(u, v) = static_cast<float>(sum / ((2 * radius + 1) * (2 * radius + 1)));
    }
  }
}

/// Both damages of a pair are found with their depths, the largest inside their outlines.
void expect_both(const DamageMap& map, const synth::SyntheticPair& pair) {
  ASSERT_EQ(map.damages.size(), 2U);
  for (const synth::DamageTruth& known : pair.damages) {
    const Damage* found = find(map, pair, known.id);
    ASSERT_NE(found, nullptr) << known.depth_m;
    EXPECT_NEAR(found->metrics->max_depth_m.value, known.depth_m, 0.15 * known.depth_m);
    EXPECT_EQ(map.ids(found->deepest_px[0], found->deepest_px[1]), found->id);
  }
}

/// Two damages whose outlines touch are both kept.
TEST(FindDamage, FindsShallowDamageBesidePothole) {
  synth::Scene scene = intact_scene();
  scene.road.blobs = {{-0.02, 0.62, 0.19, 0.008, 0, 1, 3}, {0.245, 0.66, 0.08, 0.09, 0, 0.2, 8}};
  ExactMaps maps(scene, 0);
  smear(maps.transformed, 6);
  maps.transformed = with_noise(maps.transformed, 0.02);
  const DamageMap map = find_damage(maps.metric());
  expect_both(map, maps.pair);
}

/// A gutter joins two potholes to one component of deep cells; each is a damage, measured inside its own outline.
TEST(FindDamage, FindsBothPotholesInAGutter) {
  synth::Scene scene = intact_scene();
  scene.road.blobs = {{-0.26, 0.65, 0.1, 0.09, 0, 0.3, 3},
                      {0.26, 0.65, 0.13, 0.06, 0, 0.3, 8},
                      {0, 0.65, 0.19, 0.016, 0, 0.3, 5, false}};
  const ExactMaps maps(scene);
  const DamageMap map = find_damage(maps.metric());
  expect_both(map, maps.pair);
  for (const synth::DamageTruth& known : maps.pair.damages) {
    const Damage* const found = find(map, maps.pair, known.id);
    ASSERT_NE(found, nullptr);
    EXPECT_GT(f_score(map.ids, found->id, maps.pair.labels, known.id), 0.85);
  }
}

/// Picture in which damages and what lies closer to one than `margin` are dark, in 1/16 grey levels.
GreyImage dark_damages(const Image<std::uint16_t>& labels, int margin) {
  constexpr float road_level = 1600, dark_level = 1000, texture = 32;
  Image<float> levels(labels.width(), labels.height());
  for (int v = 0; v < labels.height(); ++v) {
    for (int u = 0; u < labels.width(); ++u) {
      bool is_dark = false;
      for (int y = std::max(0, v - margin); y <= std::min(labels.height() - 1, v + margin); ++y) {
        for (int x = std::max(0, u - margin); x <= std::min(labels.width() - 1, u + margin); ++x) {
          is_dark |= labels(x, y) != 0;
        }
      }
      levels(u, v) = is_dark ? dark_level : road_level;
    }
  }
  levels = with_noise(levels, texture);
  GreyImage grey(labels.width(), labels.height());
  for (std::size_t k = 0; k < levels.pixels(); ++k) {
    grey.row(0)[k] = static_cast<std::int16_t>(std::lround(levels.row(0)[k]));
  }
  return grey;
}

/// Where the strip between two damages is as dark as they are, the shallow one does not take cells of the deep one, nor
/// its depth.
TEST(FindDamage, ToneJoinsNoCellsOfDeeperPothole) {
  synth::Scene scene = intact_scene();
  scene.road.blobs = {{-0.05, 0.65, 0.2, 0.014, 0, 0.3, 3}, {0.265, 0.65, 0.1, 0.09, 0, 0.1, 8}};
  const ExactMaps maps(scene);
  const GreyImage grey = dark_damages(maps.pair.labels, 5);
  DamageInput input = maps.metric();
  input.grey = grey;
  const DamageMap map = find_damage(input);
  expect_both(map, maps.pair);
  for (const synth::DamageTruth& known : maps.pair.damages) {
    const Damage* const found = find(map, maps.pair, known.id);
    ASSERT_NE(found, nullptr);
    const auto [u, v] = found->deepest_px;
    EXPECT_EQ(maps.pair.labels(u, v), known.id);
  }
}

/// Potholes around a bump are not what it is compared with.
TEST(FindDamage, FindsLowBumpBetweenPotholes) {
  synth::Scene scene = intact_scene();
  for (const double around : {0.5, 1.5, 2.5, 3.5, 4.5, 5.5}) {
    scene.road.blobs.push_back({0.21 * std::cos(around), 0.66 + 0.21 * std::sin(around), 0.1, 0.06, 0, 0.3, 3});
  }
  scene.road.blobs.push_back({0, 0.66, 0.09, -0.009, 0, 0.5, 7});
  const ExactMaps maps(scene);
  const DamageMap map = find_damage(maps.metric());
  const synth::DamageTruth& bump = maps.pair.damages.back();
  ASSERT_EQ(bump.kind, "bump");
  const Damage* found = find(map, maps.pair, bump.id);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->kind, DamageKind::protrusion);
  EXPECT_NEAR(found->metrics->max_depth_m.value, bump.depth_m, 0.15 * bump.depth_m);
}

/// A bump keeps clear of a block too high for damage, with which its foot is connected through smeared depths.
TEST(FindDamage, FindsBumpBesideHighBlock) {
  synth::Scene scene = intact_scene();
  scene.road.blobs = {{0.35, 0.6, 0.12, -0.03, 0, 0.3, 3}};
  ExactMaps maps(scene, 0);
  const double height_m = ground_plane(maps.pair.plane, maps.pair.calibration).height_m;
  const auto& bump = maps.pair.damages[0];
  const auto [bump_u, bump_v] = label_centroid(maps.pair, bump.id);
  int bump_end = 0;
  for (int u = 0; u < maps.pair.labels.width(); ++u) {
    if (maps.pair.labels(u, static_cast<int>(bump_v)) == bump.id) bump_end = u;
  }
  constexpr int gap = 12;
  for (int v = static_cast<int>(bump_v) - 60; v < static_cast<int>(bump_v) + 60; ++v) {
    for (int u = bump_end - 2; u < bump_end + gap + 80; ++u) {
      constexpr double bridge_px = 0.035;  // between the level of an outline and that of a core
      const double block_px = maps.pair.plane.disparity(u, v) * (height_m / (height_m - 0.3) - 1);
      const double change = u < bump_end + gap ? bridge_px : block_px;
      maps.transformed(u, v) += static_cast<float>(change);
    }
  }
  maps.transformed = with_noise(maps.transformed, 0.02);
  const DamageMap map = find_damage(maps.metric());
  ASSERT_EQ(map.damages.size(), 1U);
  EXPECT_EQ(map.damages[0].kind, DamageKind::protrusion);
  EXPECT_NEAR(map.damages[0].metrics->max_depth_m.value, bump.depth_m, 0.3 * bump.depth_m);
}

/// A terrace around a pothole, hardly deeper somewhere than elsewhere, is no damage of its own, whatever its depth: no
/// level divides the two.
TEST(FindDamage, TerraceOfPotholeIsNoSecondDamage) {
  constexpr int width = 480, height = 360;
  constexpr float road_px = 40, hole_px = 3, noise_px = 0.05F;
  for (float terrace_px = 0.06F; terrace_px < 0.3F; terrace_px += 0.01F) {
    Image<float> transformed(width, height);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const double radius = std::hypot(u - 240, v - 180), from_spot = std::hypot(u - 240, v - 95);
        const float depth = radius < 50      ? hole_px
                            : radius >= 110  ? 0
                            : from_spot < 12 ? 1.08F * terrace_px
                                             : terrace_px;
        transformed(u, v) = road_px - depth;
      }
    }
    smear(transformed, 6);
    transformed = with_noise(transformed, noise_px);
    DamageInput input;
    input.transformed = transformed;
    const DamageMap map = find_damage(input);
    ASSERT_EQ(map.damages.size(), 1U) << terrace_px;
  }
}

/// The road on one side of a step 12 mm lower than on the other, with a pothole 80 mm deep near the step: seen straight
/// down from 4 m, d = 50 px, 12.5 px per metre of depth. The lower side is no part of the pothole.
TEST(FindDamage, StepOfRoadDoesNotWidenPothole) {
  constexpr int width = 960, height = 600;
  constexpr double pixel_m = 0.004, radius_m = 0.2;
  Image<float> transformed(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double from_middle_m = pixel_m * std::hypot(u - 400, v - 300), step_m = u < 460 ? 0.012 : 0;
      const double hole_m = 0.08 * std::clamp((radius_m - from_middle_m) / 0.06 + 0.5, 0.0, 1.0);
      transformed(u, v) = static_cast<float>(30 - 12.5 * (step_m + hole_m));
    }
  }
  smear(transformed, 6);
  transformed = with_noise(transformed, 0.03);
  Image<float> disparity = transformed;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) disparity(u, v) += 20;
  }
  DamageInput input;
  input.transformed = transformed;
  input.disparity = disparity;
  input.plane = DisparityPlane{50, 0, 0};
  input.calibration = StereoCalibration{1000, 479.5, 299.5, 0.2};
  const DamageMap map = find_damage(input);
  const auto hollow = std::find_if(map.damages.begin(), map.damages.end(),
                                   [](const Damage& one) { return one.kind == DamageKind::depression; });
  ASSERT_NE(hollow, map.damages.end());
  const double foot_m = radius_m + 0.03 + 6 * pixel_m,
               area_m2 = std::numbers::pi * foot_m * foot_m;  // of its smoothed wall
  EXPECT_NEAR(hollow->metrics->area_m2.value, area_m2, 0.15 * area_m2);
}

}  // namespace
}  // namespace roadstereo
