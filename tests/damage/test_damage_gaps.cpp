// Gaps in the map: of a pothole, and of none.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>

#include "roadstereo/damage.hpp"
#include "tests/damage/damage_checks.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

/// Pixels of a damage near its wall, in a disk.
void forget_disk(ExactMaps& maps, double u0, double v0, double radius) {
  for (int v = 0; v < maps.transformed.height(); ++v) {
    for (int u = 0; u < maps.transformed.width(); ++u) {
      if (std::hypot(u - u0, v - v0) <= radius) maps.forget(u, v);
    }
  }
}

TEST(FindDamage, GapInWallBelongsToPothole) {
  ExactMaps maps = damaged();
  const Damage* whole = nullptr;
  const DamageMap before = find_damage(maps.metric());
  whole = find(before, maps.pair, 1);
  ASSERT_NE(whole, nullptr);
  const double u = whole->box_px[0] + 12, v = whole->centroid_px[1];  // within the left wall
  forget_disk(maps, u, v, 7);
  const DamageMap map = find_damage(maps.metric());
  expect_truth(map, maps.pair);
  EXPECT_EQ(map.ids(static_cast<int>(u), static_cast<int>(v)), find(map, maps.pair, 1)->id);
  EXPECT_TRUE(std::isfinite(map.depth(static_cast<int>(u), static_cast<int>(v))));
  EXPECT_LT(find(map, maps.pair, 1)->measured_share, whole->measured_share);
}

/// Where the rim is missing, too, the hole is not enclosed by what was seen of the pothole.
TEST(FindDamage, GapOverRimBelongsToPothole) {
  ExactMaps maps = damaged();
  const DamageMap before = find_damage(maps.metric());
  const Damage* whole = find(before, maps.pair, 1);
  ASSERT_NE(whole, nullptr);
  const double u = whole->box_px[0] + 9, v = whole->centroid_px[1];
  forget_disk(maps, u, v, 13);
  const DamageMap map = find_damage(maps.metric());
  double hidden = 0, found = 0;
  for (int row = 0; row < map.ids.height(); ++row) {
    for (int column = 0; column < map.ids.width(); ++column) {
      if (std::hypot(column - u, row - v) > 13 || maps.pair.labels(column, row) != 1) continue;
      ++hidden;
      found += map.ids(column, row) != 0 ? 1 : 0;
    }
  }
  EXPECT_GE(found, 0.6 * hidden);
  expect_truth(map, maps.pair);
}

TEST(FindDamage, GapsInRoadAreNoDamage) {
  ExactMaps maps = damaged();
  forget_disk(maps, 320, 40, 20);
  forget_disk(maps, 560, 330, 12);
  for (int v = 0; v < maps.transformed.height(); ++v) {
    for (int u = 0; u < 30; ++u) maps.forget(u, v);
  }
  for (const DamageInput& input : {maps.metric(), maps.pixels()}) {
    const DamageMap map = find_damage(input);
    EXPECT_EQ(map.ids(320, 40), 0);
    EXPECT_EQ(map.ids(560, 330), 0);
    EXPECT_TRUE(std::isnan(map.depth(320, 40)));
    for (int v = 0; v < map.ids.height(); ++v) EXPECT_EQ(map.ids(10, v), 0);
    EXPECT_EQ(map.damages.size(), 2U);
  }
}

/// What nobody saw is not the pothole's because the pothole ends there: a gap from the border of the picture into it,
/// and one from it far into the road.
TEST(FindDamage, GapBeyondPotholeIsNoDamage) {
  const auto [middle_u, middle_v] = label_centroid(damaged().pair, 1);
  for (const bool to_border : {true, false}) {
    ExactMaps maps = damaged();
    const int first = to_border ? 0 : static_cast<int>(middle_u) + 30;
    const int last = to_border ? static_cast<int>(middle_u) - 30 : static_cast<int>(middle_u) + 190;
    const int row = static_cast<int>(middle_v);
    for (int v = row - 25; v <= row + 25; ++v) {
      for (int u = first; u <= last; ++u) maps.forget(u, v);
    }
    const DamageMap map = find_damage(maps.metric());
    ASSERT_NE(find(map, maps.pair, 1), nullptr);
    int invented = 0;
    for (int v = row - 25; v <= row + 25; ++v) {
      for (int u = first; u <= last; ++u) invented += map.ids(u, v) != 0 && maps.pair.labels(u, v) == 0 ? 1 : 0;
    }
    EXPECT_EQ(invented, 0) << (to_border ? "at the border" : "in the road");
  }
}

TEST(FindDamage, InfinityIsInvalidLikeNan) {
  ExactMaps missing = damaged();
  forget_disk(missing, 320, 40, 20);
  const auto [u, v] = label_centroid(missing.pair, 1);
  forget_disk(missing, u, v, 4);
  ExactMaps endless = missing;
  for (int row = 0; row < endless.transformed.height(); ++row) {
    for (int column = 0; column < endless.transformed.width(); ++column) {
      float& value = endless.transformed(column, row);
      constexpr float endless_value = std::numeric_limits<float>::infinity();
      constexpr float no_data = std::numeric_limits<float>::max();  // of many programs
      if (std::isnan(value)) value = (column % 2 == 0 ? endless_value : no_data) * (row % 2 == 0 ? 1.0F : -1.0F);
    }
  }
  for (const bool metric : {true, false}) {
    const DamageMap one = find_damage(metric ? missing.metric() : missing.pixels());
    const DamageMap other = find_damage(metric ? endless.metric() : endless.pixels());
    EXPECT_EQ(one.ids, other.ids);
    ASSERT_EQ(one.damages.size(), other.damages.size());
    for (std::size_t k = 0; k < one.damages.size(); ++k) {
      EXPECT_EQ(one.damages[k].mean_depth_px, other.damages[k].mean_depth_px);
      EXPECT_EQ(one.damages[k].measured_share, other.damages[k].measured_share);
    }
  }
}

}  // namespace
}  // namespace roadstereo
