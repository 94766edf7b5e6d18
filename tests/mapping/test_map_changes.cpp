// Damage of two days, on maps of exact disparities with noise.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "roadstereo/map_changes.hpp"
#include "tests/mapping/step_frame.hpp"

namespace roadstereo {
namespace {

constexpr double camera_m = 2, step_x = 0.1, step_y = 0.05, radius_m = 0.2;

/// Map of six frames over a round step of that depth, with noise of 0.1 px.
RoadMap map_of(double depth_m, const std::string& name, unsigned seed, double x = 0) {
  RoadMapOptions options;
  options.threads = 1;
  const auto folder =
      std::filesystem::temp_directory_path() / ("roadstereo_changes_" + name + std::to_string(getpid()));
  RoadMap map(folder, options);
  for (unsigned k = 0; k < 6; ++k) {
    map.add(
        TestFrame(looking_down(x + 0.02 * k, 0, camera_m), {step_x, step_y, radius_m, depth_m}, 0.1, seed + k).frame);
  }
  return map;
}

/// Record of the step, or of a place beside it.
RoadDamageRecord record(double depth_m, double depth_error_m, double area_m2, double x = step_x, double y = step_y) {
  RoadDamageRecord record;
  record.best.damage.kind = DamageKind::depression;
  record.best.at_m = {x, y};
  record.max_depth_m = record.mean_depth_m = {depth_m, depth_error_m};
  record.area_m2 = {area_m2, 0.01};
  for (int j = -10; j < 10; ++j) {
    for (int i = -10; i < 10; ++i) {
      if (std::hypot(i + 0.5, j + 0.5) * footprint_m > radius_m) continue;
      record.best.footprint.push_back(
          {static_cast<int>(std::floor(x / footprint_m)) + i, static_cast<int>(std::floor(y / footprint_m)) + j});
    }
  }
  return record;
}

class MapChanges : public testing::Test {
 protected:
  const RoadMap flat_ = map_of(0, "flat", 1), deep_ = map_of(0.05, "deep", 100), deeper_ = map_of(0.09, "deeper", 200);
  const std::vector<RoadDamageRecord> none_, small_{record(0.05, 0.008, 0.126)}, large_{record(0.09, 0.008, 0.126)};
};

TEST_F(MapChanges, NewAndRepairedDamageMovesHeights) {
  const auto fresh = compare_damage(none_, flat_, small_, deep_);
  ASSERT_EQ(fresh.size(), 1U);
  EXPECT_EQ(fresh[0].kind, DamageChangeKind::appeared);
  EXPECT_EQ(fresh[0].after, 0U);
  EXPECT_FALSE(fresh[0].before);
  // Of a flat bottom of 0.2 m radius 50 mm deep; the footprint has the cells of its border, where bilinear samples
  // rise.
  EXPECT_NEAR(fresh[0].height_change_m.value, -0.05, 0.006);
  EXPECT_GT(fresh[0].height_change_m.std_error, 0.0005);
  EXPECT_LT(fresh[0].height_change_m.std_error, 0.025);
  const auto gone = compare_damage(small_, deep_, none_, flat_);
  ASSERT_EQ(gone.size(), 1U);
  EXPECT_EQ(gone[0].kind, DamageChangeKind::repaired);
  EXPECT_NEAR(gone[0].height_change_m.value, 0.05, 0.006);
}

TEST_F(MapChanges, WhatOnlyOneListHasButBothMapsIsNoChange) {
  const RoadMap again = map_of(0.05, "again", 300);
  EXPECT_TRUE(compare_damage(none_, again, small_, deep_).empty());
  EXPECT_TRUE(compare_damage(small_, deep_, none_, again).empty());
  EXPECT_TRUE(compare_damage(small_, again, small_, deep_).empty());
}

TEST_F(MapChanges, DeeperDamageHasGrownAndShallowerIsReduced) {
  const auto grown = compare_damage(small_, deep_, large_, deeper_);
  ASSERT_EQ(grown.size(), 1U);
  EXPECT_EQ(grown[0].kind, DamageChangeKind::grown);
  EXPECT_NEAR(grown[0].height_change_m.value, -0.04, 0.006);
  const auto reduced = compare_damage(large_, deeper_, small_, deep_);
  ASSERT_EQ(reduced.size(), 1U);
  EXPECT_EQ(reduced[0].kind, DamageChangeKind::reduced);
}

// Areas differ by 0.03 m², 2.1 times √2 · 0.01 m²; by 0.027 m², 1.9 times.
TEST_F(MapChanges, AreaCountsBeyondTwoStandardErrors) {
  const RoadMap again = map_of(0.05, "again", 300);
  const std::vector<RoadDamageRecord> wider{record(0.05, 0.008, 0.156)}, hardly{record(0.05, 0.008, 0.153)};
  const auto grown = compare_damage(small_, deep_, wider, again);
  ASSERT_EQ(grown.size(), 1U);
  EXPECT_EQ(grown[0].kind, DamageChangeKind::grown);
  EXPECT_TRUE(compare_damage(small_, deep_, hardly, again).empty());
}

TEST_F(MapChanges, PlacesThatOneDayDoesNotMeasureAreLeftOut) {
  const RoadMap elsewhere = map_of(0, "elsewhere", 400, 30);
  EXPECT_TRUE(compare_damage(none_, elsewhere, small_, deep_).empty());
  EXPECT_TRUE(compare_damage(small_, deep_, none_, elsewhere).empty());
  EXPECT_FALSE(is_superseded(small_[0], deep_, none_, elsewhere));
  EXPECT_TRUE(measures(deep_, small_[0].best.footprint));
  EXPECT_FALSE(measures(elsewhere, small_[0].best.footprint));
}

// A later day that measures the same heights but is too noisy to list the damage does not make it go away.
TEST_F(MapChanges, OnlyPartnerOrRepairSupersedes) {
  const RoadMap again = map_of(0.05, "again", 300);
  EXPECT_FALSE(is_superseded(small_[0], deep_, none_, again));
  EXPECT_TRUE(is_superseded(small_[0], deep_, small_, again));
  EXPECT_TRUE(is_superseded(small_[0], deep_, none_, flat_));
}

// The box around a rut that runs diagonally for 400 m has 1.6e9 cells of 1 cm.
TEST_F(MapChanges, LongDamageIsReadInParts) {
  RoadDamageRecord rut = record(0.05, 0.008, 0.126);
  EXPECT_TRUE(measures(deep_, rut.best.footprint));
  MapCells& cells = rut.best.footprint;
  for (int k = 100; k < 20'000; ++k) cells.push_back({k, k});
  EXPECT_FALSE(measures(deep_, cells));
  EXPECT_FALSE(is_superseded(rut, deep_, none_, flat_));
  EXPECT_TRUE(compare_damage(none_, flat_, std::vector{rut}, deep_).empty());
}

}  // namespace
}  // namespace roadstereo
