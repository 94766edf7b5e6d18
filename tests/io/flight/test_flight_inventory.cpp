// The inventory of a flight's damages.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "roadstereo/io/flight_inventory.hpp"
#include "tests/io/flight/flight_frames.hpp"

namespace roadstereo::io {
namespace {

TEST(FlightInventory, JoinsMovingDamage) {
  FlightInventory inventory;
  for (int i = 0; i < 5; ++i) {
    const std::vector<std::int64_t> ids =
        inventory.add(frame_of(i, {pothole(100, 50 + 25 * i, 0.05, 0.01 - 0.001 * i), pothole(300, 50 + 25 * i)}));
    EXPECT_EQ(ids, (std::vector<std::int64_t>{1, 2}));
  }
  ASSERT_EQ(inventory.damages().size(), 2U);
  EXPECT_EQ(inventory.damages()[0].sightings, 5);
  EXPECT_EQ(inventory.damages()[0].frame, 4) << "the least error";
  EXPECT_EQ(inventory.damages()[1].frame, 0) << "the first of equals";
}

TEST(FlightInventory, LearnsImageMotion) {
  FlightInventory inventory;
  int v = 20;
  // Steps of 45 px: boxes of 40 px do not overlap, once the motion has been learned from steps that grow.
  for (const int step : {0, 20, 30, 38, 45, 45, 45}) {
    v += step;
    EXPECT_EQ(inventory.add(frame_of(v, {pothole(100, v)})), std::vector<std::int64_t>{1}) << v;
  }
}

// A rut stays where it is in the picture while the road moves; a pothole in it moves 25 px a frame and is not the rut.
TEST(FlightInventory, PotholeInRutIsAnotherDamage) {
  FlightInventory inventory;
  Damage rut = pothole(100, 180);
  rut.metrics->distress = Distress::rut;
  rut.box_px = {60, 0, 160, 359};
  for (int i = 0; i < 12; ++i) {
    const bool has_pothole = i >= 3 && i < 9;
    const std::vector<std::int64_t> ids = inventory.add(
        frame_of(i, has_pothole ? std::vector{pothole(100, 40 + 25 * i), rut} : std::vector{rut}));  // deepest first
    EXPECT_EQ(ids.back(), 1) << i;
    EXPECT_EQ(ids.front(), has_pothole ? 2 : 1) << i;
  }
  EXPECT_EQ(inventory.damages().size(), 2U);
}

TEST(FlightInventory, BridgesOneMissedFrameOnly) {
  FlightInventory inventory;
  inventory.add(frame_of(0, {pothole(100, 100)}));
  inventory.add(frame_of(1, {}));
  EXPECT_EQ(inventory.add(frame_of(2, {pothole(100, 100)})), std::vector<std::int64_t>{1});
  for (int i = 3; i < 6; ++i) inventory.add(frame_of(i, {}));
  EXPECT_EQ(inventory.add(frame_of(6, {pothole(100, 100)})), std::vector<std::int64_t>{2});
  Damage bump = pothole(100, 100);
  bump.kind = DamageKind::protrusion;
  EXPECT_EQ(inventory.add(frame_of(7, {bump})), std::vector<std::int64_t>{3}) << "a bump is no pothole";
}

/// A candidate that is a damage in a later frame is a damage, measured there, although its error was smaller before.
TEST(FlightInventory, CandidateBecomesDamage) {
  FlightInventory inventory;
  FlightFrame first = frame_of(4, {});
  first.candidates = {pothole(100, 100, 0.02, 0.001), pothole(300, 100)};
  EXPECT_EQ(inventory.add(first), (std::vector<std::int64_t>{1, 2}));
  EXPECT_TRUE(inventory.damages()[0].candidate);
  FlightFrame second = frame_of(5, {pothole(100, 110, 0.04, 0.002)});
  second.candidates = {pothole(300, 110)};
  EXPECT_EQ(inventory.add(second), (std::vector<std::int64_t>{1, 2}));
  FlightFrame third = frame_of(6, {});
  third.candidates = {pothole(100, 120, 0.01, 0.0001)};
  inventory.add(third);
  const RoadDamage& damage = inventory.damages()[0];
  EXPECT_FALSE(damage.candidate);
  EXPECT_EQ(damage.best.metrics->max_depth_m.value, 0.04);
  EXPECT_EQ(damage.sightings, 3);
  EXPECT_EQ(damage.first_frame, 4);
  EXPECT_EQ(damage.last_frame, 6);
  EXPECT_EQ(damage.frame, 5);
  EXPECT_EQ(worst_first(inventory.damages(), false).size(), 1U);
  ASSERT_EQ(worst_first(inventory.damages(), true).size(), 1U);
  EXPECT_EQ(worst_first(inventory.damages(), true)[0].id, 2);
}

// Noise is sure of itself in one frame of many.
TEST(FlightInventory, TwoFramesMustAgree) {
  const auto candidate_of = [](const std::vector<double>& confidences) {
    FlightInventory inventory;
    for (std::size_t i = 0; i < confidences.size(); ++i) {
      Damage damage = pothole(100, 100);
      damage.confidence = confidences[i];
      const bool is_damage = damage.confidence >= 0.5;
      FlightFrame frame =
          frame_of(static_cast<std::int64_t>(i), is_damage ? std::vector{damage} : std::vector<Damage>());
      if (!is_damage) frame.candidates = {damage};
      inventory.add(frame);
    }
    return inventory.damages().at(0).candidate;
  };
  EXPECT_FALSE(candidate_of({0.55}));
  EXPECT_TRUE(candidate_of({0.2, 0.55, 0.3}));
  EXPECT_FALSE(candidate_of({0.2, 0.55, 0.46, 0.1}));
  EXPECT_FALSE(candidate_of({0.3, 0.95})) << "odds of 3/7 and 19";
  EXPECT_TRUE(candidate_of({0.45, 0.45, 0.45}));
}

/// A frame of a camera `at_m` along the road that sees square potholes of 0.4 m, at those places along it; what the
/// pictures show of them tells nothing.
FlightFrame frame_along(std::int64_t index, double at_m, const std::vector<double>& potholes_m, int piece = 0) {
  std::vector<Damage> damages;
  for (const double pothole_m : potholes_m) {
    damages.push_back(pothole(static_cast<int>(100 + 37 * index % 400), static_cast<int>(50 + 83 * index % 300)));
    const double y = pothole_m - at_m;
    damages.back().metrics->outline_m = {{-0.2, y - 0.2}, {0.2, y - 0.2}, {0.2, y + 0.2}, {-0.2, y + 0.2}};
  }
  FlightFrame frame = frame_of(index, damages);
  frame.road_status = RoadStatus::found;
  // World: x right, y down, z ahead; road: x right, y ahead, z up, 1.5 m below the camera.
  frame.pose = {piece, {1, 0, 0, 0, 0, 0, -1, 1.5, 0, 1, 0, at_m}};
  return frame;
}

/// Minutes at a traffic light: of hundreds of looks at the same noise two are sure of themselves.
TEST(FlightInventory, FramesOfStandingCameraAreOneView) {
  const auto candidate_of = [](const std::vector<double>& at_m, const std::vector<double>& confidences) {
    FlightInventory inventory;
    for (std::size_t i = 0; i < confidences.size(); ++i) {
      if (std::isnan(at_m[i])) {
        inventory.add(frame_of(static_cast<std::int64_t>(i), {}));
        continue;
      }
      FlightFrame frame = frame_along(static_cast<std::int64_t>(i), at_m[i], {8});
      frame.height_m = 1.5;
      frame.damages[0].confidence = confidences[i];
      if (confidences[i] < 0.5) std::swap(frame.candidates, frame.damages);
      EXPECT_EQ(inventory.add(frame), std::vector<std::int64_t>{1});
    }
    return inventory.damages().at(0).candidate;
  };
  const std::vector<double> noise{0.2, 0.55, 0.2, 0.55, 0.2};
  EXPECT_TRUE(candidate_of({0, 0, 0.003, -0.003, 0.002}, noise)) << "0.015 m are a hundredth of the height";
  EXPECT_FALSE(candidate_of({0, 0.1, 0.2, 0.3, 0.4}, noise));
  EXPECT_FALSE(candidate_of({0, 0, 0, 0, 0}, {0.4, 0.6, 0.6, 0.5, 0.6}));
  EXPECT_TRUE(candidate_of({0, 0, NAN, 0, 0}, {0.2, 0.55, 0, 0.55, 0.2})) << "a truck hides the road for a while";
  // 0.2 and 0.55 while it stands are worth 0.36; 0.75 from elsewhere outweighs it, 0.6 does not.
  EXPECT_FALSE(candidate_of({0, 0, 1}, {0.2, 0.55, 0.75}));
  EXPECT_TRUE(candidate_of({0, 0, 1}, {0.2, 0.55, 0.6}));
}

// Forth, a stop, back, and forth again after frames that saw none of them, 3 m a frame.
TEST(FlightInventory, KnowsDamageByItsPlace) {
  FlightInventory inventory;
  using Ids = std::vector<std::int64_t>;
  EXPECT_EQ(inventory.add(frame_along(0, 0, {8, 9})), (Ids{1, 2}));
  EXPECT_EQ(inventory.add(frame_along(1, 3, {9, 8})), (Ids{2, 1}));
  EXPECT_EQ(inventory.add(frame_along(2, 3, {8.1, 9.1})), (Ids{1, 2})) << "0.1 m off";
  EXPECT_EQ(inventory.add(frame_along(3, 0, {8})), Ids{1});
  for (int i = 4; i < 10; ++i) inventory.add(frame_along(i, -3, {}));
  EXPECT_EQ(inventory.add(frame_along(10, 6, {8.45, 9})), (Ids{3, 2})) << "0.45 m off is another";
  EXPECT_EQ(inventory.damages().size(), 3U);
  EXPECT_EQ(inventory.damages()[1].sightings, 4);
}

// A rut 0.5 m wide that the border cuts in all frames: each shows 4 m of it, ten of them, 1 m apart, 13 m.
TEST(FlightInventory, DamageLongerThanViewHasAreaOfAll) {
  FlightInventory inventory;
  for (int i = 0; i < 10; ++i) {
    FlightFrame frame = frame_along(i, i, {0});
    Damage& rut = frame.damages[0];
    rut.cut_by_border = true;
    DamageMetrics& metrics = *rut.metrics;
    metrics.distress = Distress::rut;
    metrics.outline_m = {{-0.25, 3}, {0.25, 3}, {0.25, 7}, {-0.25, 7}};
    metrics.area_m2 = {2, 0.1};
    metrics.volume_m3 = {0.02, 0.002};
    metrics.length_m = 4;
    metrics.unit = DistressUnit::square_metre;
    metrics.quantity = 2;
    EXPECT_EQ(inventory.add(frame), std::vector<std::int64_t>{1});
  }
  FlightFrame elsewhere = frame_along(10, 500, {0}, 1);  // no link tells where; the picture joins it
  elsewhere.road_status = RoadStatus::tracked;
  Damage& again = elsewhere.damages[0];
  again.metrics->distress = Distress::rut;
  again.cut_by_border = true;
  again.box_px = pothole(100 + 37 * 9, 50 + 83 * 9 % 300).box_px;
  EXPECT_EQ(inventory.add(elsewhere), std::vector<std::int64_t>{1});
  const DamageMetrics& metrics = *inventory.damages()[0].best.metrics;
  EXPECT_NEAR(metrics.area_m2.value, 6.5, 0.1);
  EXPECT_NEAR(metrics.area_m2.std_error, 0.325, 0.005);
  EXPECT_NEAR(metrics.volume_m3.value, 0.065, 0.001);
  EXPECT_NEAR(metrics.length_m, 13, 0.2);
  EXPECT_NEAR(metrics.quantity, 6.5, 0.1);
}

/// A damage that the border cuts, a rectangle of the road (x0, y0, x1, y1), metres.
Damage cut_damage(const std::array<double, 4>& box_m, double area_m2, const Measurement& depth_m) {
  Damage damage = pothole(100, 100);
  damage.cut_by_border = true;
  DamageMetrics& metrics = *damage.metrics;
  const auto& [x0, y0, x1, y1] = box_m;
  metrics.outline_m = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  metrics.area_m2 = {area_m2, 0.1 * area_m2};
  metrics.volume_m3 = {0.02 * area_m2, 0.004 * area_m2};
  metrics.max_depth_m = depth_m;
  metrics.length_m = std::max(x1 - x0, y1 - y0);
  metrics.unit = DistressUnit::square_metre;
  metrics.quantity = area_m2;
  return damage;
}

/// What the inventory tells of one damage, seen from a camera at these places along the road.
RoadDamage seen_from(const std::vector<double>& at_m, const std::vector<Damage>& sightings) {
  FlightInventory inventory;
  for (std::size_t i = 0; i < at_m.size(); ++i) {
    FlightFrame frame = frame_along(static_cast<std::int64_t>(i), at_m[i], {});
    frame.damages = {sightings[i]};
    EXPECT_EQ(inventory.add(frame), std::vector<std::int64_t>{1});
  }
  return inventory.damages().at(0);
}

// A splinter of 0.027 m², whose outline has next to no area, and the hollow of 1 m × 1.2 m beside it, four times as
// deep: their depths differ by 69 mm, 4.2 standard errors. They are neither 13 m² nor 598 m long.
TEST(FlightInventory, SplinterOfOtherDepthIsNotExtended) {
  const Damage splinter = cut_damage({1, 3, 1.003, 4}, 0.027, {0.025, 0.008});
  const Damage hollow = cut_damage({0.5, 3, 1.5, 4.2}, 1.2, {0.094, 0.014});
  for (const bool first : {true, false}) {
    const RoadDamage damage = seen_from({0, 0}, first ? std::vector{splinter, hollow} : std::vector{hollow, splinter});
    EXPECT_EQ(damage.frame, first ? 1 : 0) << "the larger one";
    const DamageMetrics& metrics = *damage.best.metrics;
    EXPECT_DOUBLE_EQ(metrics.area_m2.value, 1.2);
    EXPECT_DOUBLE_EQ(metrics.area_m2.std_error, 0.12);
    EXPECT_DOUBLE_EQ(metrics.volume_m3.value, 0.024);
    EXPECT_DOUBLE_EQ(metrics.length_m, 1.2);
    EXPECT_DOUBLE_EQ(metrics.quantity, 1.2);
  }
}

// 2 m and then 4 m of a rut 0.5 m wide, from 3 m to 5 m and from 4 m to 8 m, the shorter one with the smaller error.
// Together they are 5 m: the larger one's 2.1 m², which its outline of 2 m² is not quite, and 0.5 m² more.
TEST(FlightInventory, SplinterOfCutDamageIsNotBest) {
  Damage half = cut_damage({-0.25, 3, 0.25, 5}, 1, {0.02, 0.001});
  Damage most = cut_damage({-0.25, 3, 0.25, 7}, 2.1, {0.021, 0.003});
  most.metrics->diameter_m = std::sqrt(2.1 * 4 / 3.14159265);
  for (const bool first : {true, false}) {
    const RoadDamage damage = first ? seen_from({0, 1}, {half, most}) : seen_from({1, 0}, {most, half});
    EXPECT_EQ(damage.frame, first ? 1 : 0);
    const DamageMetrics& metrics = *damage.best.metrics;
    EXPECT_NEAR(metrics.area_m2.value, 2.6, 0.03);
    EXPECT_NEAR(metrics.area_m2.std_error, 0.26, 0.003);
    EXPECT_NEAR(metrics.quantity, 2.6, 0.03);
    EXPECT_NEAR(metrics.length_m, 5, 1e-9);
    EXPECT_NEAR(metrics.diameter_m, std::sqrt(2.6 * 4 / 3.14159265), 0.02);
    EXPECT_EQ(metrics.max_depth_m.value, 0.021);
  }
  half.metrics->area_m2.value = 1.1;  // more than half
  for (const bool first : {true, false}) {
    const RoadDamage damage = first ? seen_from({0, 1}, {half, most}) : seen_from({1, 0}, {most, half});
    EXPECT_EQ(damage.frame, first ? 0 : 1) << "the smaller error";
    EXPECT_NEAR(damage.best.metrics->area_m2.value, 2.6, 0.03) << "whichever frame is best";
    EXPECT_NEAR(damage.best.metrics->area_m2.std_error, 0.24, 0.01) << "0.1 m² of 1.1 m²";
    EXPECT_EQ(damage.best.metrics->max_depth_m.value, 0.02);
  }
}

// Ten sightings of 4 m of a rut 0.5 m wide, 1 m apart, that lie 0.1 m to the left and to the right in turn: 13 m of
// 0.5 m, although all together cover 0.7 m across.
TEST(FlightInventory, ManySightingsMakeNoWiderRut) {
  std::vector<double> at_m;
  std::vector<Damage> sightings;
  for (int i = 0; i < 10; ++i) {
    const double x = i % 2 == 0 ? -0.35 : -0.15;
    at_m.push_back(i);
    sightings.push_back(cut_damage({x, 3, x + 0.5, 7}, 2, {0.02, 0.001}));
  }
  const DamageMetrics metrics = *seen_from(at_m, sightings).best.metrics;
  EXPECT_NEAR(metrics.area_m2.value, 6.5, 0.1);
  EXPECT_NEAR(metrics.length_m, 13, 0.1);
}

// 2 m and 1 m more of what is 1 m wide. The standard counts large potholes as several, small ones as one, and cracks by
// their length.
TEST(FlightInventory, QuantityOfCutDamageIsInItsUnit) {
  const auto quantity_of = [](DistressUnit unit, double quantity) {
    Damage one = cut_damage({0, 3, 1, 5}, 2, {0.05, 0.01});
    one.metrics->unit = unit;
    one.metrics->quantity = quantity;
    return seen_from({0, 1}, {one, cut_damage({0, 3, 1, 5}, 1.9, {0.05, 0.01})}).best.metrics->quantity;
  };
  EXPECT_NEAR(quantity_of(DistressUnit::count, 4), 6, 0.05);
  EXPECT_EQ(quantity_of(DistressUnit::count, 1), 1);
  EXPECT_NEAR(quantity_of(DistressUnit::metre, 2), 3, 1e-9);
  EXPECT_NEAR(quantity_of(DistressUnit::square_metre, 2), 3, 0.05);
}

// Where no link connects two pieces, the pictures decide; boxes there do not overlap.
TEST(FlightInventory, PlacesOfOtherPiecesAreUnrelated) {
  FlightInventory inventory;
  inventory.add(frame_along(0, 0, {8}));
  EXPECT_EQ(inventory.add(frame_along(400, 0, {8}, 1)), std::vector<std::int64_t>{2});
}

TEST(FlightInventory, CutStartsNewDamages) {
  FlightInventory inventory;
  inventory.add(frame_of(0, {pothole(100, 100)}));
  FlightFrame cut = frame_of(1, {pothole(100, 100)});
  cut.road_status = RoadStatus::found;
  EXPECT_EQ(inventory.add(cut), std::vector<std::int64_t>{2});
  FlightFrame refused = frame_of(2, {});
  refused.status = FrameStatus::rejected;
  refused.road_status = RoadStatus::found;
  inventory.add(refused);
  EXPECT_EQ(inventory.add(frame_of(3, {pothole(100, 100)})), std::vector<std::int64_t>{2})
      << "over a frame that is missing";
}

// One that is medium or high, about as likely, is worse than a minor one, and than a medium one if that is shallower.
TEST(FlightInventory, UncertainSeverityRanksAsExpectedClass) {
  FlightInventory inventory;
  std::vector<Damage> damages{pothole(100, 100), pothole(300, 100), pothole(500, 100)};
  const auto grade = [&](std::size_t k, Severity severity, const SeverityProbabilities& of) {
    damages[k].metrics->severity = severity;
    damages[k].metrics->severity_probabilities = of;
  };
  grade(0, Severity::minor, {.minor = 1, .low = 0, .medium = 0, .high = 0});
  grade(1, Severity::uncertain, {.minor = 0, .low = 0, .medium = 0.5, .high = 0.5});
  grade(2, Severity::medium, {.minor = 0, .low = 0, .medium = 1, .high = 0});
  inventory.add(frame_of(0, damages));
  std::vector<std::int64_t> order;
  for (const RoadDamage& damage : worst_first(inventory.damages(), false)) order.push_back(damage.id);
  EXPECT_EQ(order, (std::vector<std::int64_t>{2, 3, 1}));
}

// A bump, which the standard has no depths for, of 110 mm is worse than a minor and a medium hollow.
TEST(FlightInventory, DamageWithoutClassesRanksByDepth) {
  FlightInventory inventory;
  std::vector<Damage> damages{pothole(100, 100, 0.008), pothole(300, 100, 0.11), pothole(500, 100, 0.03)};
  damages[0].metrics->severity = Severity::minor;
  damages[1].kind = DamageKind::protrusion;
  damages[1].metrics->severity = Severity::unknown;
  inventory.add(frame_of(0, damages));
  std::vector<std::int64_t> order;
  for (const RoadDamage& damage : worst_first(inventory.damages(), false)) order.push_back(damage.id);
  EXPECT_EQ(order, (std::vector<std::int64_t>{2, 3, 1}));
}

TEST(FlightInventory, FrameWithoutRoadIsNoCut) {
  FlightInventory inventory;
  inventory.add(frame_of(0, {pothole(100, 100)}));
  FlightFrame glare = frame_of(1, {});
  glare.road_status = RoadStatus::none;
  inventory.add(glare);
  FlightFrame again = frame_of(2, {pothole(100, 100)});
  again.road_status = RoadStatus::found;
  EXPECT_EQ(inventory.add(again), std::vector<std::int64_t>{1});
}

// No damage tells that the camera has stopped, or drives back: boxes of 40 px would have to be 45 px farther down.
TEST(FlightInventory, MotionMayEndWhileNoDamageIsSeen) {
  for (const int step : {0, 10, -10}) {
    FlightInventory inventory;
    for (const int v : {20, 20, 40, 70, 108, 153, 198}) inventory.add(frame_of(v, {pothole(100, v)}));
    ASSERT_EQ(inventory.damages().size(), 1U);
    for (int i = 0; i < 4; ++i) inventory.add(frame_of(200 + i, {}));
    for (int i = 0; i < 5; ++i) {
      EXPECT_EQ(inventory.add(frame_of(204 + i, {pothole(100, 150 + i * step)})), std::vector<std::int64_t>{2}) << step;
    }
  }
}

TEST(FlightInventory, PrefersWholeSightingsAndSortsBySeverity) {
  FlightInventory inventory;
  Damage cut = pothole(100, 100, 0.05, 0.0001);
  cut.cut_by_border = true;
  inventory.add(frame_of(0, {cut, pothole(300, 100, 0.03)}));
  inventory.add(frame_of(1, {pothole(100, 100, 0.04, 0.002), pothole(300, 100, 0.03)}));
  EXPECT_EQ(inventory.damages()[0].frame, 1);
  Damage deep = pothole(400, 300, 0.02);
  deep.metrics->severity = Severity::high;
  inventory.add(frame_of(2, {deep}));
  const std::vector<RoadDamage> worst = worst_first(inventory.damages(), false);
  ASSERT_EQ(worst.size(), 3U);
  EXPECT_EQ(worst[0].id, 3) << "severity before depth";
  EXPECT_EQ(worst[1].id, 1);
}

}  // namespace
}  // namespace roadstereo::io
