// Ruts below a straightedge across the road, and damage of a road that has them: heights in closed form.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/straightedge.hpp"
#include "damage/cells.hpp"
#include "damage/ruts.hpp"
#include "roadstereo/ground_plane.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

/// A road 2 m below a camera whose axis is 50° below the horizon.
struct Lane {
  static constexpr int width = 640, height = 360;
  using Lift = std::function<double(double x, double y)>;

  StereoCalibration calibration{450, 319.5, 179.5, 0.3, 0, width, height};
  DisparityPlane plane;
  Image<float> disparity{width, height}, transformed;

  /// `lift` above the plane in metres at (x, y), to the right and ahead of the camera, metres.
  explicit Lane(const Lift& lift, double noise_px = 0.05) {
    constexpr double camera_m = 2, pitch = 50 * std::numbers::pi / 180;
    const double fb = calibration.focal_px * calibration.baseline_m;
    const double down_per_row = std::cos(pitch) / calibration.focal_px;
    plane.a1 = fb * down_per_row / camera_m;
    plane.a0 = fb * (std::sin(pitch) - calibration.cy_px * down_per_row) / camera_m;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const double row = (v - calibration.cy_px) / calibration.focal_px;
        const double down = std::sin(pitch) + std::cos(pitch) * row, ahead = std::cos(pitch) - std::sin(pitch) * row;
        const double z = camera_m / down;
        const double height_m = lift((u - calibration.cx_px) / calibration.focal_px * z, ahead * z);
        disparity(u, v) = static_cast<float>(fb * down / (camera_m - height_m));
      }
    }
    disparity = with_noise(disparity, noise_px);
    transformed = transformed_by(plane, disparity);
  }

  DamageInput input() const {
    DamageInput input;
    input.transformed = transformed;
    input.disparity = disparity;
    input.plane = plane;
    input.calibration = calibration;
    return input;
  }
};

/// A rut of a parabola's section about the line x = middle + slope·y.
double rut(double x, double y, double middle, double slope, double width_m, double depth_m) {
  const double across = 2 * (x - middle - slope * y) / width_m;
  return -depth_m * std::max(0.0, 1 - across * across);
}

double wheel_tracks(double x, double y) {
  return rut(x, y, -0.85, 0, 0.7, 0.02) + rut(x, y, 0.85, 0, 0.7, 0.02);
}

/// Cells of a lane with their coordinates, and the ruts that are found in them.
struct Found {
  Cells cells;
  SurfaceCoordinates coordinates;
  Ruts ruts;

  explicit Found(const Lane& lane)
      : cells(make_cells(lane.transformed, {}, 0, 2, 1)), coordinates(surface_coordinates(cells, lane.input(), 1)) {
    ruts = find_ruts(cells, coordinates, fit_road_surface(cells, coordinates, 1), 0, 1);
  }

  /// Share of the cells nearer to the line x = middle + slope·y than `near_m` that lie in a rut.
  double share_inside(double middle, double slope, double near_m) const {
    double inside = 0, all = 0;
    for (int j = 0; j < cells.height(); ++j) {
      for (int i = 0; i < cells.width(); ++i) {
        if (std::abs(coordinates.x(i, j) - middle - slope * coordinates.y(i, j)) > near_m) continue;
        ++all;
        inside += ruts.labels(i, j) != 0 ? 1 : 0;
      }
    }
    return inside / all;
  }
};

TEST(Straightedge, GapsOfSections) {
  std::vector<double> parabola, crown;
  for (int i = 0; i <= 40; ++i) {
    const double x = 0.1 * i - 2;
    parabola.push_back(0.3 * x + rut(x, 0, 0, 0, 1, 0.04));
    crown.push_back(-0.02 * std::abs(x) - 0.01 * x * x);
  }
  const std::vector<double> gaps = straightedge_gaps(parabola, 0.1, 2);
  for (int i = 0; i <= 40; ++i) {
    const double x = 0.1 * i - 2;
    EXPECT_NEAR(gaps[static_cast<std::size_t>(i)], -rut(x, 0, 0, 0, 1, 0.04), 1e-12) << x;
  }
  for (const double gap : straightedge_gaps(crown, 0.1, 2)) EXPECT_NEAR(gap, 0, 1e-12) << "it is convex";
  // A straightedge shorter than the rut touches both of its walls: 0.4 m of a parabola of 1 m and 40 mm.
  EXPECT_NEAR(straightedge_gaps(parabola, 0.1, 0.4)[20], 0.04 * 0.4 * 0.4, 1e-12);
  parabola[20] = NAN;
  EXPECT_EQ(straightedge_gaps(parabola, 0.1, 2)[20], 0);
  EXPECT_TRUE(straightedge_gaps({}, 0.1, 2).empty());
}

TEST(FindRuts, WheelTracks) {
  const Found found{Lane(wheel_tracks)};
  ASSERT_EQ(found.ruts.significances.size(), 2U);
  for (const double middle : {-0.85, 0.85}) EXPECT_GT(found.share_inside(middle, 0, 0.2), 0.99) << middle;
  EXPECT_EQ(found.share_inside(0, 0, 0.35), 0) << "between them";
}

TEST(FindRuts, MapWithoutNoise) {
  const Lane lane(wheel_tracks, 0);
  const Found found{lane};
  ASSERT_EQ(found.ruts.significances.size(), 2U);
  for (const double significance : found.ruts.significances) EXPECT_TRUE(std::isfinite(significance));
  const DamageMap map = find_damage(lane.input());
  ASSERT_EQ(map.damages.size(), 2U);
  for (const Damage& damage : map.damages) EXPECT_GT(damage.confidence, 0.9);
}

TEST(FindRuts, ObliqueOneOnCrown) {
  const double slope = std::tan(17 * std::numbers::pi / 180);
  const Found found{Lane(
      [&](double x, double y) { return rut(x, y, -0.7, slope, 0.6, 0.02) - 0.025 * std::abs(x - 0.5 - slope * y); })};
  ASSERT_EQ(found.ruts.significances.size(), 1U);
  EXPECT_GT(found.share_inside(-0.7, slope, 0.15), 0.97);
  EXPECT_LT(found.share_inside(0.3, slope, 0.4), 0.01);
}

// A level road, its crown, a kerb, whose top the straightedge would rest on, a hump across, a pothole, bumps in a row
// that are as high as a rut is deep but leave half of the road level, and waves along the road.
TEST(FindRuts, NoneElsewhere) {
  const auto disc = [](double x, double y, double at_x, double at_y, double radius) {
    return std::max(0.0, 1 - std::pow(std::hypot(x - at_x, y - at_y) / radius, 2));
  };
  const std::vector<std::pair<std::string, Lane::Lift>> roads{
      {"level", [](double, double) { return 0.0; }},
      {"crown", [](double x, double) { return -0.03 * std::abs(x) - 0.004 * x * x; }},
      {"kerb", [](double x, double) { return x > 0.9 ? 0.05 : -0.02 * std::max(0.0, x - 0.4); }},
      {"hump", [](double, double y) { return 0.05 * std::max(0.0, 1 - std::pow((y - 1.7) / 0.4, 2)); }},
      {"pothole", [&](double x, double y) { return -0.06 * disc(x, y, 0.1, 1.7, 0.4); }},
      {"bumps", [&](double x, double y) { return 0.02 * (disc(x, y, -0.4, 1.3, 0.35) + disc(x, y, 0.5, 1.3, 0.35)); }},
      {"waves", [](double x, double y) {
         return 0.004 * std::sin(2.3 * x + 1) * std::sin(3.1 * y) + 0.01 * std::sin(1.5 * y);
       }}};
  for (const auto& [name, lift] : roads) EXPECT_TRUE(Found{Lane(lift)}.ruts.empty()) << name;
}

TEST(FindRuts, NeedsMetres) {
  const Lane lane(wheel_tracks);
  DamageInput input = lane.input();
  input.calibration.reset();
  const Cells cells = make_cells(lane.transformed, {}, 0, 2, 1);
  const SurfaceCoordinates coordinates = surface_coordinates(cells, input, 1);
  EXPECT_TRUE(find_ruts(cells, coordinates, fit_road_surface(cells, coordinates, 1), 0, 1).empty());
}

/// A camera whose picture has the road across it: ruts run along x.
TEST(FindDamage, FollowsYawOfMount) {
  const Lane lane([](double x, double y) { return rut(y, x, 1.7, 0, 0.7, 0.02); });
  const DamageMap across = find_damage(lane.input());
  ASSERT_FALSE(across.damages.empty());
  for (const Damage& dip : across.damages) EXPECT_NE(dip.metrics->distress, Distress::rut);
  for (const double yaw_deg : {90.0, -90.0, 270.0, 75.0}) {
    DamageOptions options;
    options.mount_yaw_deg = yaw_deg;
    const DamageMap map = find_damage(lane.input(), options);
    ASSERT_EQ(map.damages.size(), 1U) << yaw_deg;
    EXPECT_EQ(map.damages[0].metrics->distress, Distress::rut) << yaw_deg;
    EXPECT_NEAR(map.damages[0].metrics->max_depth_m.value, 0.02, 0.003) << yaw_deg;
  }
}

TEST(FindDamage, FollowsObliqueYawOfMount) {
  // Camera turned by 45° to the right of the travel: the road leads to the upper left, x = −y + c.
  const Lane lane([](double x, double y) { return rut(x, y, 1.7, -1, 0.7 * std::numbers::sqrt2, 0.02); });
  const auto ruts_at = [&](double yaw_deg) {
    DamageOptions options;
    options.mount_yaw_deg = yaw_deg;
    int ruts = 0;
    for (const Damage& damage : find_damage(lane.input(), options).damages) {
      ruts += damage.metrics->distress == Distress::rut ? 1 : 0;
    }
    return ruts;
  };
  EXPECT_EQ(ruts_at(45), 1);
  EXPECT_EQ(ruts_at(30), 1);
  EXPECT_EQ(ruts_at(-45), 0);
  EXPECT_EQ(ruts_at(0), 0);
}

/// Two ruts are the larger part of what is seen: the surface lies on what is left of the road.
TEST(FindDamage, MeasuresWheelTracks) {
  const Lane lane(wheel_tracks);
  DamageInput input = lane.input();
  const DamageMap map = find_damage(input);
  ASSERT_EQ(map.damages.size(), 2U);
  for (const Damage& damage : map.damages) {
    EXPECT_EQ(damage.metrics->distress, Distress::rut);
    EXPECT_NEAR(damage.metrics->max_depth_m.value, 0.02, 0.003);
    EXPECT_NEAR(std::abs(damage.metrics->road_centroid_m[0]), 0.85, 0.1);
    EXPECT_GT(damage.evidence.rut_significance, 14);
  }
  EXPECT_LT(map.noise_px, 0.05);
}

/// Wheels go on where a track has a hole: both are listed, each with its own depth.
TEST(FindDamage, SeparatesPotholeFromRut) {
  const Lane lane([](double x, double y) {
    return wheel_tracks(x, y) - 0.06 * std::clamp((0.22 - std::hypot(x - 0.85, y - 1.7)) / 0.06, 0.0, 1.0);
  });
  const DamageMap map = find_damage(lane.input());
  ASSERT_EQ(map.damages.size(), 3U);
  EXPECT_EQ(map.damages[0].metrics->distress, Distress::pothole);
  EXPECT_NEAR(map.damages[0].metrics->max_depth_m.value, 0.08, 0.005);
  EXPECT_NEAR(map.damages[0].metrics->road_centroid_m[0], 0.85, 0.05);
  EXPECT_NEAR(map.damages[0].metrics->road_centroid_m[1], 1.7, 0.05);
  for (std::size_t k = 1; k < 3; ++k) {
    EXPECT_EQ(map.damages[k].metrics->distress, Distress::rut);
    EXPECT_NEAR(map.damages[k].metrics->max_depth_m.value, 0.02, 0.003);
  }
}

}  // namespace
}  // namespace roadstereo
