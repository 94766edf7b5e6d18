#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "roadstereo/cross_section.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/relief.hpp"
#include "tests/damage/damage_from_truth.hpp"

namespace roadstereo {
namespace {

constexpr double height_m = 2;
constexpr double deepest_m = 0.08;

/// A camera that looks straight down on a trough: |u − 100| ≤ 40, |v − 60| ≤ 10, deepest along the middle.
struct Trough {
  StereoCalibration rig{500, 100, 60, 0.1, 0, 200, 120};
  DamageMap map;
  Image<float> disparity{200, 120};

  Trough() {
    map.metric = true;
    map.ids.assign(200, 120, 0);
    map.road.assign(200, 120, 255);
    map.surface.assign(200, 120, 30);
    map.depth.assign(200, 120, 0);
    for (int v = 50; v <= 70; ++v) {
      for (int u = 60; u <= 140; ++u) {
        map.ids(u, v) = 7;
        map.depth(u, v) = static_cast<float>(depth_at(u, v));
      }
    }
    for (int v = 0; v < 120; ++v) {
      for (int u = 0; u < 200; ++u) {
        disparity(u, v) = static_cast<float>(rig.focal_px * rig.baseline_m / (height_m + map.depth(u, v)));
      }
    }
    Damage damage;
    damage.id = 7;
    damage.box_px = {60, 50, 140, 70};
    damage.deepest_px = {100, 60};
    damage.centroid_px = {100, 60};
    damage.metrics.emplace();
    map.damages.push_back(damage);
  }

  static double depth_at(int u, int v) {
    return deepest_m * (1 - std::abs(u - 100) / 41.0) * (1 - std::abs(v - 60) / 11.0);
  }
  const Damage& damage() const { return map.damages.front(); }
};

TEST(CrossSection, RunsAlongLongAxisInMetres) {
  const Trough trough;
  const CrossSection section = extract_cross_section(trough.map, trough.damage(), trough.disparity, trough.rig);
  EXPECT_TRUE(section.metric);
  ASSERT_EQ(section.pixel.size(), section.position.size());
  ASSERT_EQ(section.pixel.size(), section.depth.size());
  EXPECT_LT(section.pixel.front()[0], 60);  // intact road at both ends
  EXPECT_GT(section.pixel.back()[0], 140);
  const double origin = (section.pixel.front()[0] - 100) * height_m / 500;
  for (std::size_t i = 0; i < section.pixel.size(); ++i) {
    const auto [u, v] = section.pixel[i];
    EXPECT_EQ(v, 60);
    const double depth = std::max(0.0, trough.map.ids(u, v) == 7 ? Trough::depth_at(u, v) : 0.0);
    EXPECT_NEAR(section.depth[i], depth, 1e-6);
    EXPECT_NEAR(section.position[i], (u - 100) * height_m / 500 - origin, 1e-5) << u;
  }
}

TEST(CrossSection, FollowsAngleOnRoad) {
  Trough trough;
  trough.map.damages.front().metrics->angle_rad = std::numbers::pi / 4;  // towards y, which is up in the image
  const CrossSection section = extract_cross_section(trough.map, trough.damage(), trough.disparity, trough.rig);
  const auto first = section.pixel.front(), last = section.pixel.back();
  EXPECT_EQ(last[0] - first[0], -(last[1] - first[1]));
  EXPECT_NE(last[0], first[0]);
}

TEST(CrossSection, HasGapsAtInvalidPixels) {
  Trough trough;
  for (int u = 90; u <= 95; ++u) trough.disparity(u, 60) = truth::nan_value;
  const CrossSection section = extract_cross_section(trough.map, trough.damage(), trough.disparity, trough.rig);
  int gaps = 0;
  for (std::size_t i = 0; i < section.pixel.size(); ++i) {
    const int u = section.pixel[i][0];
    EXPECT_EQ(std::isnan(section.depth[i]), u >= 90 && u <= 95) << u;
    EXPECT_TRUE(std::isfinite(section.filled[i]));
    gaps += std::isnan(section.depth[i]) ? 1 : 0;
  }
  EXPECT_EQ(gaps, 6);
}

TEST(CrossSection, UncalibratedIsInPixels) {
  Trough trough;
  trough.map.metric = false;
  trough.map.damages.front().metrics.reset();
  const CrossSection section = extract_cross_section(trough.map, trough.damage(), trough.disparity);
  EXPECT_FALSE(section.metric);
  for (std::size_t i = 0; i < section.pixel.size(); ++i) {
    EXPECT_EQ(section.pixel[i][1], 60);
    EXPECT_EQ(section.position[i], section.pixel[i][0] - section.pixel.front()[0]);
  }
}

TEST(CrossSection, UncalibratedFollowsSlantedRegion) {
  DamageMap map;
  map.ids.assign(200, 200, 0);
  map.road.assign(200, 200, 255);
  map.depth.assign(200, 200, 0);
  const double angle = std::numbers::pi / 6;
  for (int v = 0; v < 200; ++v) {
    for (int u = 0; u < 200; ++u) {
      const double a = (u - 100) * std::cos(angle) + (v - 100) * std::sin(angle);
      const double b = (v - 100) * std::cos(angle) - (u - 100) * std::sin(angle);
      if (std::abs(a) <= 60 && std::abs(b) <= 8) map.ids(u, v) = 1;
    }
  }
  Damage damage;
  damage.id = 1;
  damage.box_px = {40, 60, 160, 140};
  damage.deepest_px = {100, 100};
  damage.centroid_px = {100, 100};
  const CrossSection section = extract_cross_section(map, damage);
  const auto first = section.pixel.front(), last = section.pixel.back();
  EXPECT_NEAR(std::atan2(last[1] - first[1], last[0] - first[0]), angle, 0.02);
  EXPECT_NEAR(section.position.back(), std::hypot(last[0] - first[0], last[1] - first[1]), 1e-9);
  EXPECT_GT(section.position.back(), 120);
}

/// A camera that looks down at a slant: positions against the road's true plane.
TEST(CrossSection, MatchesTruthUnderPitchedCamera) {
  synth::Scene scene = synth::named_scene("demo");
  scene.road.camber = 0;
  scene.road.cracks.clear();
  const synth::SyntheticPair pair = synth::render(scene);
  const TrueDamage truth = damage_from_truth(pair);
  ASSERT_EQ(truth.map.damages.size(), 3U);
  const RoadAxes frame = road_axes(ground_plane(pair.plane, pair.calibration));
  for (const Damage& damage : truth.map.damages) {
    const CrossSection section = extract_cross_section(truth.map, damage, truth.disparity, pair.calibration);
    ASSERT_TRUE(section.metric);
    const auto place = [&](std::size_t i) {
      const auto [u, v] = section.pixel[i];
      const auto at = frame.to_road(pair.calibration.point_m(u, v, pair.plane.disparity(u, v)));
      return std::array<double, 2>{at[0], at[1]};
    };
    const auto first = place(0), last = place(section.pixel.size() - 1);
    const double angle = std::atan2(last[1] - first[1], last[0] - first[0]);
    EXPECT_LT(std::abs(std::sin(angle - damage.metrics->angle_rad)), 0.03) << damage.id;
    for (std::size_t i = 0; i < section.pixel.size(); ++i) {
      const auto at = place(i);
      EXPECT_NEAR(section.position[i], std::hypot(at[0] - first[0], at[1] - first[1]), 0.0005) << damage.id << " " << i;
    }
    EXPECT_NEAR(std::abs(*std::max_element(section.filled.begin(), section.filled.end(),
                                           [](double a, double b) { return std::abs(a) < std::abs(b); })),
                damage.metrics->max_depth_m.value, 0.003);
  }
}

TEST(CrossSection, RejectsMapsOfOtherSize) {
  Trough trough;
  const Image<float> small(10, 10);
  EXPECT_THROW(extract_cross_section(trough.map, trough.damage(), small, trough.rig), Error);
  trough.map.damages.front().deepest_px = {300, 10};
  EXPECT_THROW(extract_cross_section(trough.map, trough.damage(), trough.disparity, trough.rig), Error);
}

TEST(Relief, PutsEveryPointOnRoad) {
  Trough trough;
  trough.disparity(100, 60) = truth::nan_value;
  const Relief relief = extract_relief(trough.map, trough.damage(), trough.disparity, trough.rig, 1000);
  EXPECT_TRUE(relief.metric);
  const int columns = relief.x.width(), rows = relief.x.height();
  const int middle_column = columns / 2, middle_row = rows / 2;  // the deepest pixel is in the middle of the box
  EXPECT_NEAR(relief.depth(middle_column, middle_row), deepest_m, 1e-6);
  EXPECT_EQ(relief.measured(middle_column, middle_row), 0);
  EXPECT_EQ(relief.measured(middle_column + 1, middle_row), 255);
  EXPECT_NEAR(relief.x(0, 0), -(columns - 1) / 2.0 * height_m / 500, 1e-4);
  EXPECT_NEAR(relief.x(columns - 1, 0), (columns - 1) / 2.0 * height_m / 500, 1e-4);
  EXPECT_NEAR(relief.y(0, 0), (rows - 1) / 2.0 * height_m / 500, 1e-4) << "forward is up in the image";
}

TEST(Relief, KeepsMaximumSize) {
  const Trough trough;
  const Relief relief = extract_relief(trough.map, trough.damage(), trough.disparity, trough.rig, 30);
  EXPECT_LE(std::max(relief.x.width(), relief.x.height()), 30);
  EXPECT_GE(relief.x.width(), 25);
  EXPECT_NEAR(relief.x(relief.x.width() - 1, 0) - relief.x(0, 0), 0.48, 0.01);  // 81 px and a quarter at either end
  EXPECT_THROW(extract_relief(trough.map, trough.damage(), trough.disparity, trough.rig, 1), Error);
}

TEST(Relief, UncalibratedIsInPixels) {
  const Trough trough;
  const Relief relief = extract_relief(trough.map, trough.damage(), {}, {}, 1000);
  EXPECT_FALSE(relief.metric);
  EXPECT_EQ(relief.x(1, 0) - relief.x(0, 0), 1);
  EXPECT_EQ(relief.y(0, 1) - relief.y(0, 0), -1);
  EXPECT_EQ(relief.measured(0, 0), 255);
}

}  // namespace
}  // namespace roadstereo
