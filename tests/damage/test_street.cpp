// Damage of a street seen from a vehicle: the road undulates, and disparities differ by several times from near to far.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "damage/road_undulation.hpp"
#include "tests/damage/damage_scene.hpp"

namespace roadstereo {
namespace {

/// A street 1.6 m below a camera that looks straight ahead, from row −45 on, above the picture, unless stated
/// otherwise.
struct Street {
  static constexpr int height = 200;
  static constexpr double camera_m = 1.6;

  int width;
  StereoCalibration calibration;
  Image<float> disparity{width, height};
  DisparityPlane plane{0, calibration.baseline_m / camera_m, 0};

  /// `lift` above the plane in metres at (x, y), to the right and ahead of the camera, metres.
  explicit Street(const std::function<double(double x, double y)>& lift, double noise_px = 0.04, int columns = 1000,
                  double horizon_px = -45)
      : width(columns), calibration{700, (columns - 1) / 2.0, horizon_px, 0.5, 0, columns, height} {
    plane.a0 = -plane.a1 * calibration.cy_px;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const double down = (v - calibration.cy_px) / calibration.focal_px;
        const double y = camera_m / down, x = (u - calibration.cx_px) / calibration.focal_px * y;
        disparity(u, v) =
            static_cast<float>(calibration.focal_px * calibration.baseline_m * down / (camera_m - lift(x, y)));
      }
    }
    disparity = with_noise(disparity, noise_px);
  }

  DamageMap find(double min_confidence = 0.5) const {
    const Image<float> transformed = transformed_by(plane, disparity);
    DamageInput input;
    input.transformed = transformed;
    input.disparity = disparity;
    input.plane = plane;
    input.calibration = calibration;
    DamageOptions options;
    options.min_confidence = min_confidence;
    return find_damage(input, options);
  }
};

/// 50 mm deep within 0.3 m of (1 m, 7 m), with a wall of 0.1 m.
double pothole(double x, double y) {
  return -0.05 * std::clamp((0.4 - std::hypot(x - 1, y - 7)) / 0.1, 0.0, 1.0);
}

/// Waves of 8 and 11 m, 20 and 15 mm high: no quadratic, but level over the 3 m of a straightedge.
double waves(double x, double y) {
  return 0.02 * std::sin(2 * std::numbers::pi * x / 8) + 0.015 * std::sin(2 * std::numbers::pi * y / 11);
}

TEST(Street, UndulationIsPartOfSurface) {
  const DamageMap level = Street(pothole).find(),
                  wavy = Street([](double x, double y) { return waves(x, y) + pothole(x, y); }).find();
  for (const DamageMap* map : {&level, &wavy}) {
    ASSERT_EQ(map->damages.size(), 1U);
    const DamageMetrics& metrics = map->damages[0].metrics.value();
    EXPECT_NEAR(metrics.max_depth_m.value, 0.05, 0.005);
    EXPECT_NEAR(metrics.road_centroid_m[0], 1, 0.05);
    EXPECT_GT(map->damages[0].evidence.extent, 0.7 / 1.5) << "its width at half of the depth";
    EXPECT_LT(map->damages[0].evidence.extent, 1.0 / 1.5) << "the foot of its wall, a cell more on either side";
  }
  // The noise is that of means of four pixels, the waves a twentieth of what they are in pixels.
  EXPECT_LT(level.noise_px, 0.03);
  EXPECT_LT(wavy.noise_px, 0.06);
  EXPECT_TRUE(Street(waves).find().damages.empty());
}

/// 48 mm at 6.2 m are fewer pixels than 40 mm at 4.5 m, where the disparity is larger.
TEST(Street, DepthIsLargestInMetres) {
  const DamageMap map = Street([](double x, double y) {
                          const double side = std::clamp((0.5 - std::abs(x)) / 0.1, 0.0, 1.0);
                          const double ends = std::clamp((1.4 - std::abs(y - 6.1)) / 0.1, 0.0, 1.0);
                          return -std::min(side, ends) * (y < 6.2 ? 0.04 : 0.048);
                        }).find();
  ASSERT_EQ(map.damages.size(), 1U);
  EXPECT_NEAR(map.damages[0].metrics->max_depth_m.value, 0.048, 0.002);
  EXPECT_NEAR(map.damages[0].metrics->wall_slope, 0.45, 0.25);
}

/// A heave from 4.6 to 20 m: 4 cm are at its near end as many pixels as 12 cm, an obstacle, at its far one.
TEST(Street, LongHeaveIsNoObstacle) {
  const DamageMap map = Street([](double x, double y) {
                          const double side = std::clamp((0.25 - std::abs(x)) / 0.1, 0.0, 1.0);
                          return 0.04 * side * std::clamp((20 - y) / 0.2, 0.0, 1.0);
                        }).find(0);
  ASSERT_GE(map.damages.size(), 1U);
  EXPECT_NEAR(map.damages[0].metrics->max_depth_m.value, 0.04, 0.004);
  EXPECT_GT(map.damages[0].metrics->length_m, 10);
}

/// A rut that runs to where the road ends, where a row of pixels covers 1 m of it: 33 m ahead. In cells of 2×2 pixels
/// the surface ends within a pixel's half row.
TEST(Street, DamageEndsWithTheRoad) {
  const auto rut = [](double x, double y) { return y < 5 ? 0.0 : -0.08 * std::max(0.0, 1 - 16 * (x - 1) * (x - 1)); };
  const Street street(rut, 0.01, 2000, -14.5);
  const DamageMap map = street.find(0);
  ASSERT_GE(map.damages.size(), 1U);
  EXPECT_NEAR(map.damages[0].metrics->max_depth_m.value, 0.08, 0.01);
  EXPECT_GT(map.damages[0].metrics->length_m, 20);
}

/// A function that is linear along both axes lies in the space of the grid; without a measurement heights return to 0.
/// 75 mm high, 1.4 m long and as wide as the street, 6 m ahead; 80 mm deep behind it.
double hump_and_pothole(double x, double y) {
  constexpr double hump_m = 0.075, half_length_m = 0.7, pothole_m = 0.08;
  const double along = std::abs(y - 6) / half_length_m;
  const double hump = along < 1 ? hump_m * std::pow(std::cos(0.5 * std::numbers::pi * along), 2) : 0;
  return hump - pothole_m * std::clamp((0.45 - std::hypot(x - 0.5, y - 8.5)) / 0.1, 0.0, 1.0);
}

/// A hump across the whole street does not end it.
TEST(Street, PotholeBeyondHumpIsFound) {
  const DamageMap map = Street(hump_and_pothole).find();  // the hump, wider than the view, is a candidate
  ASSERT_EQ(map.damages.size(), 1U);
  ASSERT_TRUE(map.damages[0].metrics);
  EXPECT_NEAR(map.damages[0].metrics->max_depth_m.value, 0.08, 0.008);
  EXPECT_NEAR(map.damages[0].metrics->road_centroid_m[1], 8.5, 0.2);
}

TEST(RoadUndulation, ReproducesLinearHeights) {
  std::vector<double> x, y, scale, value, weight;
  for (int i = 0; i <= 60; ++i) {
    for (int j = 0; j <= 80; ++j) {
      x.push_back(0.1 * i - 3);
      y.push_back(4 + 0.1 * j);
      scale.push_back(30 / y.back());
      value.push_back(scale.back() * (0.01 * x.back() - 0.004 * (y.back() - 8)));
      weight.push_back(1e6);
    }
  }
  RoadUndulation undulation(x, y);
  undulation.fit(scale, value, weight);
  for (std::size_t k = 0; k < x.size(); k += 7) {
    EXPECT_NEAR(undulation.height(k), 0.01 * x[k] - 0.004 * (y[k] - 8), 1e-3);
  }
  const float at[] = {1.0F, NAN}, ahead[] = {8.0F, 8.0F}, pixels[] = {10.0F, 10.0F};
  float values[] = {2.0F, NAN};
  undulation.add_to(at, ahead, pixels, 2, values);
  EXPECT_NEAR(values[0], 2 + 10 * 0.01, 1e-3);
  EXPECT_TRUE(std::isnan(values[1]));
}

// A metre of height is 28 px of disparity 4 m ahead and 2.8 px 40 m ahead, where a node has a tenth of the samples.
TEST(RoadUndulation, SolvesFarNodesAsWellAsNearOnes) {
  constexpr double focal_px = 1400, baseline_m = 0.12, camera_m = 1.5;
  std::vector<double> x, y, scale, value;
  const auto height_m = [](double across, double ahead) { return 0.003 * across + 0.002 * (ahead - 20); };
  for (int v = 52; v < 540; v += 2) {
    for (int u = -960; u < 960; u += 16) {
      y.push_back(focal_px * camera_m / v);
      x.push_back(u * y.back() / focal_px);
      scale.push_back(focal_px * baseline_m / y.back() / camera_m);
      value.push_back(scale.back() * height_m(x.back(), y.back()));
    }
  }
  const std::vector<double> weight(x.size(), 1 / (0.03 * 0.03));
  RoadUndulation undulation(x, y);
  undulation.fit(scale, value, weight);
  double worst_m = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (y[k] > 35 || std::abs(x[k]) > 8) continue;  // the prior counts at the sides
    worst_m = std::max(worst_m, std::abs(undulation.height(k) - height_m(x[k], y[k])));
  }
  EXPECT_LT(worst_m, 1.5e-3);
}

TEST(RoadUndulation, NeedsMoreThanOneCell) {
  const std::vector<double> x{0, 1.4, 0, 1.4}, y{2, 2, 3.4, 3.4};
  EXPECT_TRUE(RoadUndulation(x, y).empty());
  EXPECT_TRUE(RoadUndulation().empty());
}

// Waves of 32 mm across the road: the outline of a pothole runs out into the dip that it lies in, where there is hardly
// a contrast. At a higher level there is.
TEST(Street, PotholeAmongDipsIsFound) {
  const auto lift = [](double x, double y) {
    const double hole = -0.05 * std::clamp((0.55 - std::hypot(x - 1, y - 7)) / 0.1, 0.0, 1.0);
    return hole - 0.016 * std::cos(2 * std::numbers::pi * (x - 1) / 3) * std::cos(2 * std::numbers::pi * (y - 7) / 1.1);
  };
  const DamageMap found = Street(lift).find();
  ASSERT_EQ(found.damages.size(), 1U);
  EXPECT_NEAR(found.damages[0].metrics->road_centroid_m[0], 1, 0.15);
  EXPECT_NEAR(found.damages[0].metrics->road_centroid_m[1], 7, 0.4);
}

}  // namespace
}  // namespace roadstereo
