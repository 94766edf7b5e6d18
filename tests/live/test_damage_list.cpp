// Damages of successive views told apart.

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "live/damage_list.hpp"

namespace roadstereo::cli {
namespace {

Damage damage_at(double u, double v, DamageKind kind, double depth_error) {
  Damage damage;
  damage.kind = kind;
  damage.centroid_px = {u, v};
  damage.box_px = {static_cast<int>(u) - 10, static_cast<int>(v) - 10, static_cast<int>(u) + 10,
                   static_cast<int>(v) + 10};
  damage.max_depth_px = {2, depth_error};
  return damage;
}

LiveView view_at(std::int64_t number, double seconds, std::vector<Damage> damages) {
  LiveView view;
  view.number = number;
  view.arrival = Clock::time_point{} + clock_span(100 + seconds);
  view.damages = std::move(damages);
  return view;
}

TEST(DamageList, JoinsMovingDamage) {
  DamageList list;
  for (int i = 0; i < 20; ++i) {  // 13 px a picture, slower at first, with gaps; a bump goes with it
    if (i % 5 == 4) continue;
    const double v = i * (i < 3 ? 8 : 13) - (i < 3 ? 0 : 10);
    list.add(view_at(
        i + 1, i / 30.0,
        {damage_at(100, v, DamageKind::depression, 0.5 - 0.01 * i), damage_at(104, v, DamageKind::protrusion, 0.3)}));
  }
  EXPECT_EQ(list.found(), 2);
  ASSERT_EQ(list.entries().size(), 2U);
  const ListedDamage& bump = list.entries()[0];
  const ListedDamage& hole = list.entries()[1];
  EXPECT_EQ(hole.best.kind, DamageKind::depression);
  EXPECT_EQ(hole.views, 16);
  EXPECT_EQ(hole.changed_in, 19) << "the last view knew it best";
  EXPECT_DOUBLE_EQ(hole.best.max_depth_px.std_error, 0.5 - 0.01 * 18);
  EXPECT_EQ(bump.changed_in, 1) << "no view knew it better than the first";
}

TEST(DamageList, SlowViewsShowOneDamage) {
  DamageList list;
  for (int i = 0; i < 4; ++i) list.add(view_at(i + 1, 1.5 * i, {damage_at(100, 90, DamageKind::depression, 0.3)}));
  EXPECT_EQ(list.found(), 1);
}

TEST(DamageList, PotholeInRutIsAnotherDamage) {
  DamageList list;
  Damage rut = damage_at(160, 90, DamageKind::depression, 0.1);
  rut.metrics.emplace().distress = Distress::rut;
  rut.box_px = {100, 0, 220, 179};
  for (int i = 0; i < 6; ++i) {  // deepest first
    list.add(view_at(i + 1, i / 30.0, {damage_at(160, 50 + 13 * i, DamageKind::depression, 0.3), rut}));
  }
  EXPECT_EQ(list.found(), 2);
  ASSERT_EQ(list.entries().size(), 2U);
  EXPECT_FALSE(list.entries()[1].best.metrics.has_value()) << "the pothole, which came first";
  EXPECT_EQ(list.entries()[1].views, 6);
}

TEST(DamageList, PrefersWholeOverCut) {
  DamageList list;
  Damage cut = damage_at(50, 10, DamageKind::depression, 0.01);
  cut.cut_by_border = true;
  list.add(view_at(1, 0, {cut}));
  list.add(view_at(2, 0.03, {damage_at(50, 15, DamageKind::depression, 0.4)}));
  list.add(view_at(3, 0.06, {cut}));
  ASSERT_EQ(list.found(), 1);
  EXPECT_FALSE(list.entries()[0].best.cut_by_border);
  EXPECT_EQ(list.entries()[0].changed_in, 2);
}

TEST(DamageList, OtherPlaceOrTimeIsNewDamage) {
  DamageList list;
  list.add(view_at(1, 0, {damage_at(50, 50, DamageKind::depression, 0.1)}));
  list.add(view_at(2, 0.03, {damage_at(200, 50, DamageKind::depression, 0.1)}));
  EXPECT_EQ(list.found(), 2);
  list.add(view_at(3, 5, {damage_at(50, 50, DamageKind::depression, 0.1)}));
  EXPECT_EQ(list.found(), 3);
  EXPECT_EQ(list.entries()[0].id, 3) << "newest first";
}

TEST(DamageList, SightingsOfSlowViewsAreOneDamage) {
  DamageList list;
  list.add(view_at(1, 0, {}));
  for (int i = 1; i < 6; ++i) list.add(view_at(i + 1, 1.5 * i, {damage_at(50, 50, DamageKind::depression, 0.1)}));
  EXPECT_EQ(list.found(), 1);
}

TEST(DamageList, KeepsLatestHundred) {
  DamageList list;
  for (int i = 0; i < 130; ++i) {
    list.add(view_at(2 * i + 1, 2.0 * i, {damage_at(50, 50, DamageKind::depression, 0.1)}));
    list.add(view_at(2 * i + 2, 2.0 * i + 0.03, {}));
  }
  EXPECT_EQ(list.found(), 130);
  EXPECT_EQ(list.entries().size(), 100U);
  EXPECT_EQ(list.entries().front().id, 130);
  EXPECT_EQ(list.entries().back().id, 31);
}

}  // namespace
}  // namespace roadstereo::cli
