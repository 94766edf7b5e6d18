// What is no damage, or only a part of it.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "roadstereo/damage.hpp"
#include "tests/damage/damage_checks.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

TEST(FindDamage, IntactRoadHasNone) {
  synth::Scene scene = intact_scene();
  for (const double camber : {0.0, 0.02, 0.04}) {
    scene.road.camber = camber;
    const ExactMaps maps(scene);
    for (const DamageInput& input : {maps.metric(), maps.pixels()}) {
      const DamageMap map = find_damage(input);
      EXPECT_TRUE(map.damages.empty()) << "camber " << camber;
      EXPECT_EQ(map.ids, Image<std::uint16_t>(640, 360, 0));
      double on_road = 0;
      for (int v = 0; v < 360; ++v) {
        for (int u = 0; u < 640; ++u) on_road += map.road(u, v) != 0 ? 1 : 0;
      }
      EXPECT_GT(on_road, 0.8 * 640 * 360) << "camber " << camber;
    }
  }
}

TEST(FindDamage, KerbIsNoDamage) {
  synth::Scene scene = intact_scene();
  for (const double height_m : {0.05, 0.12, 0.18}) {
    scene.road.kerbs = {{0.45, height_m, 0.02}};
    const ExactMaps maps(scene);
    EXPECT_TRUE(find_damage(maps.metric()).damages.empty()) << height_m;
    EXPECT_TRUE(find_damage(maps.pixels()).damages.empty()) << height_m;
  }
}

/// Lifts a rectangle of the picture: n·p = h − z, so that d grows by the factor h / (h − z).
ExactMaps with_block(double lift_m) {
  ExactMaps maps(intact_scene());
  const double height_m = ground_plane(maps.pair.plane, maps.pair.calibration).height_m;
  for (int v = 100; v < 260; ++v) {
    for (int u = 200; u < 420; ++u) {
      const double change = maps.pair.plane.disparity(u, v) * (height_m / (height_m - lift_m) - 1);
      maps.disparity(u, v) += static_cast<float>(change);
      maps.transformed(u, v) += static_cast<float>(change);
    }
  }
  return maps;
}

TEST(FindDamage, HighBlockIsNoDamageLowBlockIsBump) {
  for (const double lift_m : {0.2, 0.6})
    EXPECT_TRUE(find_damage(with_block(lift_m).metric()).damages.empty()) << lift_m;
  const DamageMap low = find_damage(with_block(0.05).metric());  // debris that a wheel climbs
  ASSERT_EQ(low.damages.size(), 1U);
  EXPECT_EQ(low.damages[0].kind, DamageKind::protrusion);
  EXPECT_NEAR(low.damages[0].metrics->max_depth_m.value, 0.05, 0.0025);
  EXPECT_NEAR(static_cast<double>(low.damages[0].pixels), 220 * 160, 0.1 * 220 * 160);
}

/// A stone of 25 mm at the edge of a heave of 6 mm: no debris as large as the heave.
TEST(FindDamage, StoneOnReliefIsNoLargerThanItself) {
  ExactMaps maps(intact_scene(), 0.1);
  const double height_m = ground_plane(maps.pair.plane, maps.pair.calibration).height_m;
  const auto lift = [&](int u, int v, double lift_m) {
    const double change = maps.pair.plane.disparity(u, v) * (height_m / (height_m - lift_m) - 1);
    maps.disparity(u, v) += static_cast<float>(change);
    maps.transformed(u, v) += static_cast<float>(change);
  };
  for (int v = 100; v < 260; ++v) {
    for (int u = 180; u < 460; ++u) {
      const bool is_stone = u >= 400 && u < 436 && v >= 150 && v < 172;
      const double from_middle = std::hypot((u - 310) / 120.0, (v - 180) / 60.0);
      lift(u, v, is_stone ? 0.025 : from_middle < 1 ? 0.006 : 0);
    }
  }
  DamageOptions options;
  options.min_confidence = 0;  // 0.42 beside the relief
  const DamageMap map = find_damage(maps.metric(), options);
  ASSERT_EQ(map.damages.size(), 1U);
  EXPECT_EQ(map.damages[0].kind, DamageKind::protrusion);
  EXPECT_NEAR(map.damages[0].metrics->max_depth_m.value, 0.025, 0.004);
  EXPECT_LT(map.damages[0].pixels, 4U * 36 * 22);
}

/// Wrong matches, as snow or dirt make them, do not cost the damage that they lie in.
TEST(FindDamage, ImpossibleDepthInsideDamageIsOutlier) {
  ExactMaps maps = damaged();
  const synth::DamageTruth& pothole = maps.pair.damages[0];
  const auto [centre_u, centre_v] = label_centroid(maps.pair, pothole.id);
  for (int v = static_cast<int>(centre_v) - 6; v < static_cast<int>(centre_v) + 6; ++v) {
    for (int u = static_cast<int>(centre_u) - 6; u < static_cast<int>(centre_u) + 6; ++u) {
      const double surface = maps.pair.plane.disparity(u, v);
      maps.disparity(u, v) -= static_cast<float>(0.4 * surface);  // far below any pothole
      maps.transformed(u, v) -= static_cast<float>(0.4 * surface);
    }
  }
  const DamageMap map = find_damage(maps.metric());
  ASSERT_EQ(map.damages.size(), 2U);
  const Damage* found = find(map, maps.pair, pothole.id);
  ASSERT_NE(found, nullptr);
  EXPECT_NEAR(found->metrics->max_depth_m.value, pothole.depth_m, 0.05 * pothole.depth_m);
  EXPECT_NEAR(found->metrics->volume_m3.value, pothole.volume_m3, 0.1 * pothole.volume_m3);
}

TEST(FindDamage, OmitsBumpsUnlessRequested) {
  DamageOptions options;
  options.protrusions = false;
  const DamageMap map = find_damage(damaged().metric(), options);
  ASSERT_EQ(map.damages.size(), 1U);
  EXPECT_EQ(map.damages[0].kind, DamageKind::depression);
}

}  // namespace
}  // namespace roadstereo
