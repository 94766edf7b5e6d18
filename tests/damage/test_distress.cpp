// Kinds of damage by their shape: rendered roads, and shapes whose slope and outline are known.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "damage/distress.hpp"
#include "damage/road_outline.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

/// A road seen straight from above, 2 m away: a pixel covers 2 mm.
struct Map {
  static constexpr int width = 640, height = 480;
  static constexpr double gsd_m = 0.002, height_m = 2, baseline_m = 0.2;

  /// `depth` in metres at (x, y) in metres from the middle of the image, y up.
  explicit Map(const std::function<double(double x, double y)>& depth) : disparity(width, height) {
    calibration.focal_px = height_m / gsd_m;
    calibration.baseline_m = baseline_m;
    calibration.cx_px = 0.5 * (width - 1);
    calibration.cy_px = 0.5 * (height - 1);
    calibration.width = width;
    calibration.height = height;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const double z = height_m + depth(gsd_m * (u - calibration.cx_px), gsd_m * (calibration.cy_px - v));
        disparity(u, v) = static_cast<float>(calibration.focal_px * baseline_m / z);
      }
    }
    disparity = with_noise(disparity, 0.02);
  }

  DamageMap find(bool calibrated = true) const {
    DamageInput input;
    input.transformed = disparity;
    input.disparity = disparity;
    input.plane = DisparityPlane{calibration.focal_px * baseline_m / height_m, 0, 0};
    if (calibrated) input.calibration = calibration;
    DamageOptions options;
    options.min_confidence = 0;
    return find_damage(input, options);
  }

  StereoCalibration calibration;
  Image<float> disparity;
};

/// Frustum of a cone: `depth` within `floor_m`, 0 beyond `rim_m`.
double frustum(double r, double depth, double floor_m, double rim_m) {
  return depth * std::clamp((rim_m - r) / (rim_m - floor_m), 0.0, 1.0);
}

const DamageMetrics& only(const DamageMap& map) {
  EXPECT_GE(map.damages.size(), 1U);
  return map.damages.at(0).metrics.value();
}

/// The wall of a cone of 60 mm over 300 mm is as steep as the cone: 0.2. That of a frustum of 60 mm over 60 mm is 1.
TEST(WallSlope, OfConeAndFrustum) {
  const DamageMap cone = Map([](double x, double y) { return frustum(std::hypot(x, y), 0.06, 0, 0.3); }).find();
  EXPECT_NEAR(only(cone).wall_slope, 0.2, 0.01);
  const DamageMap pit = Map([](double x, double y) { return frustum(std::hypot(x, y), 0.06, 0.14, 0.20); }).find();
  EXPECT_NEAR(only(pit).wall_slope, 1, 0.1);
  // An ellipse of twice the length: the mean of its walls lies between 0.5 and 1.
  const DamageMap oval = Map([](double x, double y) { return frustum(std::hypot(x, y / 2), 0.06, 0.1, 0.16); }).find();
  EXPECT_GT(only(oval).wall_slope, 0.5);
  EXPECT_LT(only(oval).wall_slope, 1);
}

/// At 2 mm a pixel the window spreads a wall over 20 mm: that of 0.2 keeps its slope, that of 1 may be as steep as
/// rise 30 mm over run √(30² − 20²) mm and counts as 1.
TEST(WallSlope, LikelyOneIsEvidence) {
  const Map cone([](double x, double y) { return frustum(std::hypot(x, y), 0.06, 0, 0.3); });
  EXPECT_NEAR(cone.find().damages.at(0).evidence.likely_wall_slope, 0.2, 0.01);
  const Map pit([](double x, double y) { return frustum(std::hypot(x, y), 0.06, 0.14, 0.20); });
  EXPECT_GT(pit.find().damages.at(0).evidence.likely_wall_slope, 0.95);
  const Map bump([](double x, double y) { return -frustum(std::hypot(x, y), 0.03, 0, 0.3); });
  EXPECT_TRUE(std::isnan(bump.find().damages.at(0).evidence.likely_wall_slope));
  // Without a calibration the focal length, 1000 px, is taken to be the width, 640 px: all is as much wider. The
  // outline is at half of the depth, from where on the wall has half of its run.
  const DamageMap pixels = cone.find(false);
  EXPECT_FALSE(pixels.metric);
  EXPECT_FALSE(pixels.damages.at(0).metrics.has_value());
  EXPECT_GT(pixels.damages.at(0).evidence.likely_wall_slope, 0.2 * 0.64);
  EXPECT_LT(pixels.damages.at(0).evidence.likely_wall_slope, 2 * 0.2 * 0.64);
}

TEST(Distress, FollowsShape) {
  struct Case {
    Distress expected;
    std::function<double(double x, double y)> depth;
  };
  const std::vector<Case> cases = {
      {Distress::pothole, [](double x, double y) { return frustum(std::hypot(x, y), 0.05, 0.12, 0.16); }},
      {Distress::depression, [](double x, double y) { return frustum(std::hypot(x, y), 0.03, 0, 0.35); }},
      {Distress::rut, [](double x, double y) { return frustum(std::hypot(x, y / 5), 0.012, 0, 0.09); }},
      {Distress::depression, [](double x, double y) { return frustum(std::hypot(x / 5, y), 0.012, 0, 0.09); }},
      {Distress::crack, [](double x, double y) { return frustum(std::hypot(x / 9, y), 0.05, 0.02, 0.03); }},
      {Distress::bump, [](double x, double y) { return -frustum(std::hypot(x, y), 0.03, 0, 0.3); }},
      {Distress::bump, [](double x, double y) { return -frustum(std::hypot(x, y), 0.09, 0, 0.3); }},  // 17°
      {Distress::debris, [](double x, double y) { return -frustum(std::hypot(x, y), 0.06, 0.08, 0.1); }},
      {Distress::kerb_step, [](double x, double) { return -frustum(std::max(0.0, 0.64 - x), 0.08, 0.14, 0.16); }},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const DamageMap map = Map(cases[i].depth).find();
    ASSERT_GE(map.damages.size(), 1U) << i;
    EXPECT_STREQ(name_of(map.damages[0].metrics->distress), name_of(cases[i].expected))
        << i << ": " << distress_reason(*map.damages[0].metrics);
  }
}

/// Steep ones of 200 mm and more: what is three times as long as wide and longer than 1.5 m is no pothole, what is
/// wider than that is no object on the road.
TEST(Distress, FollowsSize) {
  constexpr double steep = 0.5, upright = 2, along_road = std::numbers::pi / 2;
  const auto distress = [](DamageKind kind, double length_m, double width_m, double angle_rad,
                           double mount_yaw_deg = 0) {
    DamageMetrics metrics;
    metrics.length_m = length_m;
    metrics.width_m = width_m;
    metrics.angle_rad = angle_rad;
    metrics.area_m2.value = 0.8 * length_m * width_m;
    metrics.diameter_m = 2 * std::sqrt(metrics.area_m2.value / std::numbers::pi);
    metrics.wall_slope = steep;
    Damage damage;
    damage.kind = kind;
    return classify_distress(damage, metrics, mount_yaw_deg, upright, false);
  };
  EXPECT_EQ(distress(DamageKind::depression, 2.4, 0.45, along_road), Distress::rut);
  EXPECT_EQ(distress(DamageKind::depression, 2.4, 0.45, 0), Distress::pothole) << "across the road";
  EXPECT_EQ(distress(DamageKind::depression, 2.4, 0.45, 0, 90), Distress::rut) << "the camera looks to the right";
  EXPECT_EQ(distress(DamageKind::depression, 2.4, 0.45, along_road, -90), Distress::pothole);
  EXPECT_EQ(distress(DamageKind::depression, 2.4, 0.45, std::numbers::pi / 4, -45), Distress::rut)
      << "0.71 to the right";
  EXPECT_EQ(distress(DamageKind::depression, 2.4, 0.45, std::numbers::pi / 4, 45), Distress::pothole);
  EXPECT_EQ(distress(DamageKind::depression, 1.2, 0.3, along_road), Distress::pothole) << "as short as potholes are";
  EXPECT_EQ(distress(DamageKind::protrusion, 0.3, 0.3, 0), Distress::debris);
  EXPECT_EQ(distress(DamageKind::protrusion, 2.4, 2, 0), Distress::bump) << "a speed table";
}

/// The area inside the outline is that of the damage, whose corners are counterclockwise.
TEST(Outline, EnclosesArea) {
  const DamageMap map = Map([](double x, double y) { return frustum(std::hypot(x, y / 2), 0.06, 0.1, 0.13); }).find();
  const std::vector<std::array<double, 2>>& corners = only(map).outline_m;
  double area_m2 = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto& from = corners[i];
    const auto& to = corners[(i + 1) % corners.size()];
    area_m2 += 0.5 * (from[0] * to[1] - to[0] * from[1]);
  }
  EXPECT_NEAR(area_m2, only(map).area_m2.value, 0.02 * area_m2);
  EXPECT_LT(corners.size(), 100U) << "simplified";
}

/// An L of 4×4 pixels without its upper right 2×2: six corners.
TEST(Outline, FollowsPixels) {
  Image<std::uint16_t> ids(9, 9, 0);
  for (int v = 2; v < 6; ++v) {
    for (int u = 3; u < (v < 4 ? 5 : 7); ++u) ids(u, v) = 7;
  }
  Damage damage;
  damage.id = 7;
  damage.box_px = {3, 2, 6, 5};
  const std::vector<std::array<double, 2>> expected{{2.5, 1.5}, {4.5, 1.5}, {4.5, 3.5},
                                                    {6.5, 3.5}, {6.5, 5.5}, {2.5, 5.5}};
  EXPECT_EQ(trace_outline(ids, damage, 0.1), expected);
  damage.id = 8;
  EXPECT_TRUE(trace_outline(ids, damage, 0.1).empty());
}

/// A region thinner than the tolerance is no line.
TEST(Outline, OfThinRegionHasArea) {
  Image<std::uint16_t> ids(60, 20, 0);
  for (int u = 3; u < 43; ++u) ids(u, 5) = ids(u, 6) = 1;
  Damage damage;
  damage.id = 1;
  damage.box_px = {3, 5, 42, 6};
  EXPECT_GE(trace_outline(ids, damage, 2).size(), 3U);
}

/// A camera 2 m above the road that looks straight down sees 640×480 pixels of 2 mm.
TEST(RoadFootprint, StraightDown) {
  const Map map([](double, double) { return 0.0; });
  const auto corners = road_footprint({100, 0, 0}, map.calibration, Map::width, Map::height);
  ASSERT_EQ(corners.size(), 4U);
  EXPECT_NEAR(corners[0][0], -0.639, 1e-9);
  EXPECT_NEAR(corners[0][1], -0.479, 1e-9);
  EXPECT_NEAR(corners[2][0], 0.639, 1e-9);
  EXPECT_NEAR(corners[2][1], 0.479, 1e-9);
}

/// Looking forward, the footprint ends where a row covers a metre: Z² = h·f.
TEST(RoadFootprint, EndsBeforeHorizon) {
  const ExactMaps& maps = damaged();
  StereoCalibration rig = maps.pair.calibration;
  const double slope = rig.baseline_m / 1.5;  // of a level camera: d = b·(v − v0) / h
  const auto corners = road_footprint({-slope * rig.cy_px, slope, 0}, rig, rig.width, rig.height);
  ASSERT_EQ(corners.size(), 4U);
  EXPECT_LE(corners[2][1], std::sqrt(1.5 * rig.focal_px));
  EXPECT_GT(corners[2][1], 0.9 * std::sqrt(1.5 * rig.focal_px));
  EXPECT_TRUE(road_footprint({-1, 0, 0}, rig, rig.width, rig.height).empty());
}

}  // namespace
}  // namespace roadstereo
