#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/degrees.hpp"
#include "mapping/footprints.hpp"
#include "tests/mapping/step_frame.hpp"

namespace roadstereo {
namespace {

double area_m2(const MapCells& cells) {
  return static_cast<double>(cells.size()) * footprint_m * footprint_m;
}

TEST(Footprint, QuadrilateralHasTheCentresInside) {
  MapCells cells;
  add_cells_inside({{{0, 0}, {3 * footprint_m, 0}, {3 * footprint_m, 2 * footprint_m}, {0, 2 * footprint_m}}}, cells);
  EXPECT_EQ(cells, (MapCells{{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}}));
  cells.clear();
  add_cells_inside({{{-0.005, -0.5}, {0.005, -0.5}, {0.005, 0.5}, {-0.005, 0.5}}}, cells);  // between two columns
  EXPECT_TRUE(cells.empty());
  cells.clear();
  add_cells_inside({{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}}, cells);  // on its corner: 2 m²
  EXPECT_NEAR(area_m2(cells), 2, 0.03);
}

TEST(Footprint, AdjoiningQuadrilateralsShareNoCell) {
  const std::array<double, 2> a{0.013, 0.007}, b{1.21, 0.33}, c{0.9, 1.4}, d{-0.2, 0.8}, middle{0.5, 0.6};
  MapCells whole, parts;
  add_cells_inside({a, b, c, d}, whole);
  for (const auto& [one, other] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, d}, std::pair{d, a}}) {
    add_cells_inside({middle, one, other, other}, parts);
  }
  std::sort(whole.begin(), whole.end(), cell_less);
  std::sort(parts.begin(), parts.end(), cell_less);
  EXPECT_EQ(whole, parts);
}

// Seen from a vehicle a pixel 15 m ahead covers 2 cm across the road and 20 cm along it.
TEST(Footprint, OfDistantDamageHasNoHoles) {
  constexpr double camera_m = 1.6, focal_px = 720, radius_m = 0.3;
  StereoCalibration calibration;
  calibration.width = 1241;
  calibration.height = 375;
  calibration.focal_px = focal_px;
  calibration.cx_px = 620;
  calibration.cy_px = 170;
  calibration.baseline_m = 0.54;
  const DisparityPlane road{-calibration.cy_px * 0.54 / camera_m, 0.54 / camera_m, 0};  // d = b/h·(v − cy)
  const RigidTransform pose{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, camera_m};
  for (const double ahead_m : {8.0, 12.0, 18.0}) {
    DamageMap found;
    found.ids.assign(calibration.width, calibration.height, 0);
    Damage damage;
    damage.id = 1;
    damage.box_px = {calibration.width, calibration.height, 0, 0};
    damage.metrics.emplace();
    for (int v = 175; v < calibration.height; ++v) {
      for (int u = 0; u < calibration.width; ++u) {
        const double z = focal_px * camera_m / (v - calibration.cy_px), x = (u - calibration.cx_px) * z / focal_px;
        if (std::hypot(x, z - ahead_m) > radius_m) continue;
        found.ids(u, v) = 1;
        damage.box_px = {std::min(damage.box_px[0], u), std::min(damage.box_px[1], v), std::max(damage.box_px[2], u),
                         std::max(damage.box_px[3], v)};
      }
    }
    found.damages = {damage};
    const std::vector<MapDamage> located = locate_damage(found, road, calibration, pose);
    ASSERT_EQ(located.size(), 1U);
    const double row_m = ahead_m * ahead_m / (focal_px * camera_m);
    EXPECT_NEAR(area_m2(located[0].footprint), std::numbers::pi * radius_m * radius_m, 2 * radius_m * row_m) << ahead_m;
  }
}

/// A camera that looks ahead, turned about the vertical: a side has no direction, so that its angle is −90 … 90°.
TEST(LocatedDamage, LongerSideTurnsWithCamera) {
  StereoCalibration calibration;
  calibration.width = 64;
  calibration.height = 48;
  calibration.focal_px = 60;
  calibration.cx_px = 32;
  calibration.cy_px = 10;
  calibration.baseline_m = 0.5;
  const DisparityPlane road{-calibration.cy_px * 0.5 / 1.6, 0.5 / 1.6, 0};
  DamageMap found;
  found.ids.assign(calibration.width, calibration.height, 0);
  found.ids(30, 40) = 1;
  Damage damage;
  damage.id = 1;
  damage.box_px = {30, 40, 30, 40};
  damage.metrics.emplace();
  damage.metrics->angle_rad = to_radians(80);
  found.damages = {damage};
  for (const double yaw_deg : {0.0, 60.0, 130.0, 170.0, -100.0}) {
    const double c = std::cos(to_radians(yaw_deg)), s = std::sin(to_radians(yaw_deg));
    const RigidTransform pose{c, 0, -s, 0, s, 0, c, 0, 0, -1, 0, 1.6};
    const std::vector<MapDamage> located = locate_damage(found, road, calibration, pose);
    ASSERT_EQ(located.size(), 1U);
    const double angle_deg = to_degrees(located[0].length_angle_rad);
    EXPECT_LE(std::abs(angle_deg), 90) << yaw_deg;
    EXPECT_NEAR(std::remainder(angle_deg - 80 - yaw_deg, 180.0), 0, 1e-9) << yaw_deg;
  }
}

}  // namespace
}  // namespace roadstereo
