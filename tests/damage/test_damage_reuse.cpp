// A result of another frame, whose memory a search takes, leaves nothing behind.

#include <gtest/gtest.h>

#include <cmath>

#include "roadstereo/damage.hpp"
#include "roadstereo/pipeline.hpp"
#include "tests/damage/damage_checks.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

/// A metric result of 640×360 pixels with damages, and with candidates.
DamageMap earlier_result() {
  DamageMap map = find_damage(damaged().metric());
  EXPECT_TRUE(map.metric);
  EXPECT_EQ(map.damages.size(), 2U);
  map.candidates = map.damages;
  return map;
}

void expect_fresh(const DamageInput& input) {
  DamageMap reused = earlier_result();
  find_damage(input, {}, 0, reused);
  expect_same(find_damage(input), reused);
}

TEST(FindDamage, ReusedResultOfPixelsIsFresh) {
  expect_fresh(damaged().pixels());
  DamageMap reused = earlier_result();
  find_damage(damaged().pixels(), {}, 0, reused);
  EXPECT_FALSE(reused.metric);
  EXPECT_FALSE(reused.non_metric_reason.empty());
  // And back: the reason goes.
  find_damage(damaged().metric(), {}, 0, reused);
  expect_same(find_damage(damaged().metric()), reused);
  EXPECT_EQ(reused.non_metric_reason, "");
}

TEST(FindDamage, ReusedResultOfIntactMapIsFresh) {
  ExactMaps intact(intact_scene());
  for (int v = 300; v < 330; ++v) {
    for (int u = 0; u < 640; u += 3) intact.forget(u, v);
  }
  expect_fresh(intact.metric());
  DamageMap reused = earlier_result();
  find_damage(intact.metric(), {}, 0, reused);
  EXPECT_TRUE(reused.damages.empty());
  EXPECT_TRUE(reused.candidates.empty());
}

TEST(FindDamage, ReusedResultOfOtherSizeIsFresh) {
  synth::Scene scene = damaged_scene();
  scene.rig.width = 480;
  scene.rig.height = 400;
  const ExactMaps other(scene);
  expect_fresh(other.metric());
  DamageMap small = find_damage(other.metric());
  find_damage(damaged().metric(), {}, 0, small);
  expect_same(find_damage(damaged().metric()), small);
}

TEST(FindDamage, ReusedResultOfFrameWithoutRoadIsFresh) {
  FrameResult frame;
  frame.disparity = damaged().disparity;
  DamageMap reused = earlier_result();
  find_damage(frame, damaged().pair.calibration, {}, 0, reused);
  expect_same(find_damage(frame, damaged().pair.calibration), reused);
  EXPECT_FALSE(reused.has_road());
  EXPECT_FALSE(reused.metric);
  EXPECT_EQ(reused.non_metric_reason, "no road was found");
  EXPECT_TRUE(reused.damages.empty());
  EXPECT_TRUE(reused.candidates.empty());
  ASSERT_EQ(reused.depth.pixels(), 640U * 360U);
  for (std::size_t k = 0; k < reused.depth.pixels(); ++k) {
    ASSERT_TRUE(std::isnan(reused.depth.row(0)[k]) && std::isnan(reused.surface.row(0)[k]));
    ASSERT_TRUE(reused.ids.row(0)[k] == 0 && reused.road.row(0)[k] == 0);
  }
}

}  // namespace
}  // namespace roadstereo
