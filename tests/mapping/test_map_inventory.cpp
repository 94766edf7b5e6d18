// Findings of one damage over frames and passes.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/map_inventory.hpp"
#include "tests/mapping/step_frame.hpp"

namespace roadstereo {
namespace {

/// Finding on a square of `side` footprint cells at (column, row).
MapDamage finding(int column, int row, int side, double depth_m, double std_error_m, double confidence) {
  MapDamage found;
  found.damage.kind = DamageKind::depression;
  found.damage.pixels = 40'000;  // 113 px radius: the window smooths little
  found.damage.confidence = confidence;
  DamageMetrics metrics;
  metrics.max_depth_m = {depth_m, std_error_m};
  metrics.mean_depth_m = {0.5 * depth_m, 0.5 * std_error_m};
  metrics.area_m2 = {0.1, 0.01};
  metrics.volume_m3 = {0.002, 0.0002};
  found.damage.metrics = metrics;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) found.footprint.push_back({column + i, row + j});
  }
  found.at_m = {(column + 0.5 * side) * footprint_m, (row + 0.5 * side) * footprint_m};
  return found;
}

/// An empty map: no frame measures the places, so that views are the sightings.
class JoinDamage : public testing::Test {
 protected:
  RoadMap map_{std::filesystem::temp_directory_path() / ("roadstereo_inventory_map" + std::to_string(::getpid())), {}};
};

TEST_F(JoinDamage, SightingsOfTwoPassesAreOneDamage) {
  std::vector<DamageSighting> sightings;
  for (int frame = 0; frame < 4; ++frame) sightings.push_back({0, frame, finding(10, 20, 10, 0.05, 0.006, 0.9)});
  for (int frame = 0; frame < 4; ++frame) sightings.push_back({1, frame, finding(12, 19, 10, 0.05, 0.006, 0.9)});
  sightings.push_back({1, 3, finding(40, 20, 10, 0.03, 0.003, 0.9)});  // another one
  const std::vector<RoadDamageRecord> records = join_damage(sightings, {}, map_, {});
  ASSERT_EQ(records.size(), 2U);
  EXPECT_EQ(records[0].sightings, 8);
  EXPECT_EQ(records[0].passes, 2);
  EXPECT_EQ(records[1].sightings, 1);
  EXPECT_NEAR(records[1].best.at_m[0], 0.9, 1e-9);
}

// Errors of 10 % of 40 mm and 16 % of 50 mm are 5 and 8 mm of the median, 50 mm: (0.04/5² + 0.05/8²)/(1/5² + 1/8²) =
// 0.0428. The map has no frames yet: its factor is that of r = 1/3, so that two views are worth one.
TEST_F(JoinDamage, FiguresAreWeightedWithInverseVariances) {
  const std::vector<DamageSighting> sightings{{0, 0, finding(0, 0, 10, 0.04, 0.004, 0.9)},
                                              {0, 1, finding(0, 0, 10, 0.05, 0.008, 0.9)}};
  const std::vector<RoadDamageRecord> records = join_damage(sightings, {}, map_, {});
  ASSERT_EQ(records.size(), 1U);
  EXPECT_NEAR(records[0].max_depth_m.value, 0.0428, 3e-4);
  EXPECT_NEAR(records[0].max_depth_m.std_error, std::sqrt(2 / (1 / 25e-6 + 1 / 64e-6)), 3e-4);
}

// Far sightings that see a tenth of the depth, as sure of it and hardly of the damage, do not count.
TEST_F(JoinDamage, UnlikelySightingsAreNotAveraged) {
  std::vector<DamageSighting> sightings;
  for (int frame = 0; frame < 6; ++frame) sightings.push_back({0, frame, finding(0, 0, 10, 0.005, 0.0005, 0.1)});
  for (int frame = 6; frame < 16; ++frame) sightings.push_back({0, frame, finding(0, 0, 10, 0.05, 0.005, 0.99)});
  const std::vector<RoadDamageRecord> records = join_damage(sightings, {}, map_, {});
  ASSERT_EQ(records.size(), 1U);
  EXPECT_NEAR(records[0].max_depth_m.value, 0.05, 1e-9);
  EXPECT_EQ(records[0].sightings, 16);
}

TEST_F(JoinDamage, AgreementRaisesConfidenceAndShrinksError) {
  std::vector<DamageSighting> sightings{{0, 0, finding(0, 0, 10, 0.03, 0.008, 0.4)}};
  EXPECT_TRUE(join_damage(sightings, {}, map_, {}).empty());
  for (int frame = 1; frame < 16; ++frame) sightings.push_back({0, frame, finding(0, 0, 10, 0.03, 0.008, 0.4)});
  const std::vector<RoadDamageRecord> records = join_damage(sightings, {}, map_, {});
  ASSERT_EQ(records.size(), 1U);
  // log-odds of 0.4, and 2.15 · ln √(16/2)
  EXPECT_NEAR(records[0].confidence, 1 / (1 + std::exp(-(std::log(0.4 / 0.6) + 2.15 * std::log(std::sqrt(8.0))))),
              1e-6);
  EXPECT_LT(records[0].max_depth_m.std_error, 0.0035);
}

TEST_F(JoinDamage, DamageOfTheMapAloneIsKept) {
  const std::vector<MapDamage> in_map{finding(0, 0, 10, 0.012, 0.002, 0.8)};
  const std::vector<RoadDamageRecord> records = join_damage({}, in_map, map_, {});
  ASSERT_EQ(records.size(), 1U);
  EXPECT_TRUE(records[0].found_in_map);
  EXPECT_EQ(records[0].sightings, 0);
  EXPECT_EQ(records[0].max_depth_m.value, 0.012);
}

// A hole of the map that every frame must have seen, and none has, is an error of the map. One that noise hides in
// single frames is not.
TEST_F(JoinDamage, SilentFramesCountAgainstDamageOfTheMap) {
  constexpr int frames = 4;
  for (int i = 0; i < frames; ++i) map_.add(TestFrame(looking_down(0.01 * i, 0, 2), {}, 0.1, 1U + unsigned(i)).frame);
  MapDamage plain = finding(-5, -5, 10, 0.03, 0.002, 0.9), hidden = plain;
  plain.damage.evidence.significance = 100;
  plain.damage.evidence.road_share = 1;
  hidden.damage.evidence.significance = 3;
  EXPECT_TRUE(join_damage({}, std::vector{plain}, map_, {}).empty());
  const std::vector<RoadDamageRecord> kept = join_damage({}, std::vector{hidden}, map_, {});
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].views, frames);
  EXPECT_NEAR(kept[0].confidence, 0.9, 0.01);
  std::vector<DamageSighting> seen, doubtful;
  for (int frame = 0; frame < frames; ++frame) {
    seen.push_back({0, frame, finding(-5, -5, 10, 0.03, 0.008, 0.9)});
    doubtful.push_back({0, frame, finding(-5, -5, 10, 0.03, 0.008, 0.01)});
  }
  const std::vector<RoadDamageRecord> records = join_damage(seen, std::vector{plain}, map_, {});
  ASSERT_EQ(records.size(), 1U);
  EXPECT_GE(records[0].confidence, 0.9);
  EXPECT_TRUE(join_damage(doubtful, std::vector{plain}, map_, {}).empty());
}

/// Finding whose place has so many pixels on a square metre, and so much noise.
MapDamage seen_from(MapDamage found, std::size_t pixels_per_m2, double noise_m) {
  found.damage.pixels = pixels_per_m2 / 10;  // it has 0.1 m²
  found.damage.metrics->resolvable_depth_m = noise_m;
  return found;
}

// A camera that drives up to a pothole doubts it from afar. Frames at a distance r tell r⁻³ · r⁻² as much: those at 8
// and 16 m of one at 4 m 1/32 and 1/1024.
TEST_F(JoinDamage, NearFramesDecide) {
  const std::vector<DamageSighting> sightings{{0, 0, seen_from(finding(0, 0, 10, 0.04, 0.03, 0.1), 1'000, 0.16)},
                                              {0, 1, seen_from(finding(0, 0, 10, 0.04, 0.02, 0.2), 8'000, 0.08)},
                                              {0, 2, seen_from(finding(0, 0, 10, 0.04, 0.01, 0.95), 64'000, 0.04)}};
  const std::vector<RoadDamageRecord> records = join_damage(sightings, {}, map_, {});
  ASSERT_EQ(records.size(), 1U);
  const auto log_odds = [](double p) { return std::log(p / (1 - p)); };
  const double mean = (log_odds(0.1) / 1024 + log_odds(0.2) / 32 + log_odds(0.95)) / (1.0 / 1024 + 1.0 / 32 + 1);
  EXPECT_NEAR(records[0].confidence, 1 / (1 + std::exp(-mean)), 1e-6);
}

// The map does not know the direction of the road: a rut across its y axis is none there.
TEST_F(JoinDamage, FramesTellDistress) {
  MapDamage in_map = finding(0, 0, 10, 0.02, 0.001, 0.95), in_frame = in_map;
  in_map.damage.metrics->distress = Distress::depression;
  in_frame.damage.metrics->distress = Distress::rut;
  in_frame.damage.metrics->severity = Severity::medium;
  const auto records = join_damage({{{0, 0, in_frame}, {0, 1, in_frame}}}, {{in_map}}, map_, {});
  ASSERT_EQ(records.size(), 1U);
  EXPECT_TRUE(records[0].found_in_map);
  EXPECT_EQ(records[0].best.damage.metrics->distress, Distress::rut);
  EXPECT_EQ(records[0].severity, Severity::medium) << "mean depth 10 mm, 15 mm at most";
  const auto alone = join_damage({}, {{in_map}}, map_, {});
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_EQ(alone[0].best.damage.metrics->distress, Distress::depression);
}

// Frames whose depths are not to be trusted have withheld the severity.
TEST_F(JoinDamage, WithheldSeverityIsWithheld) {
  MapDamage graded = finding(0, 0, 10, 0.05, 0.002, 0.9);
  graded.damage.metrics->distress = Distress::pothole;
  MapDamage withheld = graded;
  graded.damage.metrics->severity = Severity::medium;
  const auto severity_of = [&](int of_graded, int of_withheld) {
    std::vector<DamageSighting> sightings;
    for (int k = 0; k < of_graded; ++k) sightings.push_back({0, k, graded});
    for (int k = 0; k < of_withheld; ++k) sightings.push_back({1, k, withheld});
    return join_damage(sightings, {}, map_, {}).at(0).severity;
  };
  EXPECT_EQ(severity_of(1, 2), Severity::unknown);
  EXPECT_NE(severity_of(2, 1), Severity::unknown);
}

// Each frame shows a part of what goes on: 10 × 20 cells of 0.02 m are 0.08 m².
TEST_F(JoinDamage, DamageCutInAllFramesHasAreaOfAll) {
  std::vector<DamageSighting> sightings;
  for (int frame = 0; frame < 3; ++frame) {
    sightings.push_back({0, frame, finding(0, 5 * frame, 10, 0.05, 0.004, 0.9)});
    sightings.back().found.damage.cut_by_border = true;
    sightings.back().found.damage.metrics->area_m2 = {0.04, 0.004};
  }
  const auto records = join_damage(sightings, {}, map_, {});
  ASSERT_EQ(records.size(), 1U);
  EXPECT_NEAR(records[0].area_m2.value, 0.08, 1e-9);
  EXPECT_NEAR(records[0].area_m2.std_error, 0.008, 1e-9);
}

TEST_F(JoinDamage, NeedsMetricValues) {
  MapDamage unmeasured = finding(0, 0, 10, 0.02, 0.002, 0.9);
  unmeasured.damage.metrics.reset();
  EXPECT_THROW((void)join_damage(std::vector<DamageSighting>{{0, 0, unmeasured}}, {}, map_, {}), Error);
}

// A crack that no frame shows whole: the map measures it, its two parts are sightings.
TEST_F(JoinDamage, PartsOfOneDamageAreOneRecord) {
  MapDamage whole = finding(0, 0, 20, 0.02, 0.002, 0.9), left = finding(0, 0, 8, 0.02, 0.004, 0.7),
            right = finding(12, 12, 8, 0.02, 0.004, 0.7);
  left.damage.cut_by_border = right.damage.cut_by_border = true;
  const std::vector<RoadDamageRecord> records =
      join_damage(std::vector<DamageSighting>{{0, 0, left}, {0, 5, right}}, std::vector{whole}, map_, {});
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].sightings, 2);
  EXPECT_EQ(records[0].max_depth_m.std_error, 0.002);
}

}  // namespace
}  // namespace roadstereo
