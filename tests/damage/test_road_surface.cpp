// The quadratic surface of the undamaged road, and the coordinates that it is fitted in.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "damage/cells.hpp"
#include "damage/road_surface.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/ground_plane.hpp"

namespace roadstereo {
namespace {

/// A rig with an offset of the principal points, over a road seen at an angle and tilted sideways.
StereoCalibration tilted_rig() {
  return {500, 150.5, 99.5, 0.2, 3, 300, 200};
}
const DisparityPlane tilted_road{40, 0.1, 0.02};

/// n·p = h on the road and h − z above it: from a ray's direction alone.
double disparity_above(const GroundPlane& plane, const StereoCalibration& rig, double u, double v, double lift_m) {
  const std::array<double, 3> ray{(u - rig.cx_px) / rig.focal_px, (v - rig.cy_px) / rig.focal_px, 1};
  const double along = plane.normal[0] * ray[0] + plane.normal[1] * ray[1] + plane.normal[2];
  return rig.focal_px * rig.baseline_m * along / (plane.height_m - lift_m) - rig.disparity_offset_px;
}

TEST(SurfaceCoordinates, ScaleIsDisparityPerMetre) {
  Cells cells;
  cells.factor = 2;
  cells.value.assign(150, 100, 30.0F);
  DamageInput input;
  input.calibration = tilted_rig();
  input.plane = tilted_road;
  const SurfaceCoordinates c = surface_coordinates(cells, input, 1);
  const GroundPlane plane = ground_plane(tilted_road, tilted_rig());
  const RoadAxes frame = road_axes(plane);
  constexpr double lift_m = 1e-5;
  for (int j = 0; j < cells.height(); j += 9) {
    for (int i = 0; i < cells.width(); i += 7) {
      const double u = cells.middle(i), v = cells.middle(j);
      const double there = disparity_above(plane, tilted_rig(), u, v, 0);
      ASSERT_NEAR(there, tilted_road.disparity(u, v), 1e-9);
      const double change = (disparity_above(plane, tilted_rig(), u, v, lift_m) - there) / lift_m;
      EXPECT_NEAR(c.scale(i, j), change, 1e-4 * change);
      const auto point = frame.to_road(tilted_rig().point_m(u, v, there));
      EXPECT_NEAR(c.x(i, j), point[0], 1e-6);
      EXPECT_NEAR(c.y(i, j), point[1], 1e-6);
    }
  }
}

// Ahead of a level camera at height h a column at depth Z is Z/f wide and a row is Z²/(f h) long: h/Z of it.
TEST(SurfaceCoordinates, AspectIsHeightOverDepth) {
  Cells cells;
  cells.factor = 2;
  cells.value.assign(160, 120, 30.0F);
  DamageInput input;
  const StereoCalibration rig{400, 159.5, 39.5, 0.2, 0, 320, 240};
  constexpr double height_m = 1.6;
  input.calibration = rig;
  input.plane = DisparityPlane{-39.5 * rig.baseline_m / height_m, rig.baseline_m / height_m, 0};
  const SurfaceCoordinates ahead = surface_coordinates(cells, input, 1);
  for (int j = 40; j < 119; j += 13) {
    const double depth_m = rig.depth_m(input.plane->disparity(0, cells.middle(j)));
    EXPECT_NEAR(ahead.aspect(80, j), height_m / depth_m, 0.01 * height_m / depth_m) << j;
  }
  EXPECT_EQ(ahead.aspect(80, 2), 1) << "in the sky";
  input.plane = DisparityPlane{50, 0, 0};
  EXPECT_NEAR(surface_coordinates(cells, input, 1).aspect(3, 100), 1, 1e-4) << "from above";
  EXPECT_EQ(surface_coordinates(cells, {}, 1).aspect(3, 100), 1);
}

/// A quadratic of the coordinates with noise and, in `spoilt` of the cells, anything.
struct QuadraticRoad {
  Cells cells;
  SurfaceCoordinates coordinates;
  Image<float> truth;

  QuadraticRoad(const DamageInput& input, const std::array<double, 6>& k, double noise, double spoilt) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0, 1);
    std::uniform_real_distribution<double> share(0, 1);
    cells.factor = 1;
    cells.image_width = 300;
    cells.image_height = 200;
    cells.value.assign(300, 200, 30.0F);
    truth.assign(300, 200, 0);
    coordinates = surface_coordinates(cells, input, 1);
    for (int j = 0; j < 200; ++j) {
      for (int i = 0; i < 300; ++i) {
        const double x = coordinates.x(i, j), y = coordinates.y(i, j);
        const double height = k[1] * x + k[2] * y + k[3] * x * x + k[4] * x * y + k[5] * y * y;
        truth(i, j) = static_cast<float>(30 + coordinates.scale(i, j) * height);
        const bool bad = share(random) < spoilt;
        const double error = bad ? -1 - 12 * share(random) : noise * normal(random);
        cells.value(i, j) = truth(i, j) + static_cast<float>(error);
      }
    }
  }

  double worst(const RoadSurface& surface) const {
    double most = 0;
    for (int j = 0; j < 200; ++j) {
      for (int i = 0; i < 300; ++i) {
        const auto error = static_cast<double>(std::abs(surface.value(i, j) - truth(i, j)));
        if (std::isnan(error) || error > most) most = error;
      }
    }
    return most;
  }
};

DamageInput calibrated() {
  DamageInput input;
  input.calibration = tilted_rig();
  input.plane = tilted_road;
  return input;
}

// Metres of height with a calibration, pixels of ℓ' without.
constexpr std::array<double, 6> camber_m{0, 0.004, -0.002, -0.006, 0.002, 0.003};
constexpr std::array<double, 6> camber_px{0, 0.3, -0.2, -0.5, 0.15, 0.25};

TEST(RoadSurface, IsExactDespiteOneSidedOutliers) {
  for (const bool metric : {true, false}) {
    const QuadraticRoad road(metric ? calibrated() : DamageInput{}, metric ? camber_m : camber_px, 0, 0.3);
    EXPECT_LT(road.worst(fit_road_surface(road.cells, road.coordinates, 1)), 1e-4) << metric;
  }
}

/// The plane alone gives the coordinates of the calibration up to an affine map, and the image does not.
TEST(RoadSurface, PlaneAloneFitsAsCalibrationDoes) {
  DamageInput input = calibrated();
  input.calibration->disparity_offset_px = 0;  // without a calibration it is not known
  const QuadraticRoad road(input, camber_m, 0, 0.3);
  input.calibration.reset();
  const SurfaceCoordinates of_plane = surface_coordinates(road.cells, input, 1);
  EXPECT_LT(road.worst(fit_road_surface(road.cells, of_plane, 1)), 1e-4);
  const SurfaceCoordinates of_image = surface_coordinates(road.cells, {}, 1);
  EXPECT_GT(road.worst(fit_road_surface(road.cells, of_image, 1)), 1e-2);
}

/// Six coefficients from n samples: the standard error of a value is σ·√(6/n) on average, thrice that in a corner; that
/// of a normal distribution's median absolute deviation is 1.17/√n of it.
TEST(RoadSurface, ErrorIsThatOfNoise) {
  constexpr double noise = 0.05, spoilt = 0.3;
  const Image<std::uint8_t> everywhere(300, 200, 255);
  for (const bool metric : {true, false}) {
    const QuadraticRoad road(metric ? calibrated() : DamageInput{}, metric ? camber_m : camber_px, noise, spoilt);
    const auto check = [&](const RoadSurface& surface, int step) {
      const double samples = 300.0 * 200 / (step * step) * (1 - spoilt);
      EXPECT_LT(road.worst(surface), 4 * 3 * noise * std::sqrt(6 / samples)) << metric << ", step " << step;
      EXPECT_NEAR(surface.noise, noise, 3 * 1.17 / std::sqrt(samples) * noise) << metric << ", step " << step;
    };
    const RoadSurface coarse = fit_road_surface(road.cells, road.coordinates, 1);
    check(coarse, 7);
    check(refit_road_surface(road.cells, road.coordinates, everywhere, coarse, Sampling::fine, 1), 4);
  }
}

TEST(RoadSurface, FitsRegionOnly) {
  QuadraticRoad road({}, camber_px, 0, 0);
  RoadSurface earlier = fit_road_surface(road.cells, road.coordinates, 1);
  earlier.noise = 0.1;
  Image<std::uint8_t> region(300, 200, 255);
  for (int j = 0; j < 200; ++j) {
    for (int i = 100; i < 300; ++i) {
      region(i, j) = 0;
      road.cells.value(i, j) += 0.3F;  // two thirds of the picture, within the reach of the weights
    }
  }
  EXPECT_LT(road.worst(refit_road_surface(road.cells, road.coordinates, region, earlier, Sampling::fine, 1)), 1e-3);
  region.assign(300, 200, 0);
  EXPECT_THROW(refit_road_surface(road.cells, road.coordinates, region, earlier, Sampling::fine, 1), Error);
}

/// Of a single row of cells nothing can be said across it; along it the fit is exact.
TEST(RoadSurface, SingleRowIsFittedAlongIt) {
  constexpr int only = 102;
  const QuadraticRoad road({}, camber_px, 0, 0);
  RoadSurface earlier = fit_road_surface(road.cells, road.coordinates, 1);
  earlier.noise = 0.1;
  Image<std::uint8_t> region(300, 200, 0);
  for (int i = 0; i < 300; ++i) region(i, only) = 255;
  const RoadSurface surface = refit_road_surface(road.cells, road.coordinates, region, earlier, Sampling::fine, 1);
  for (int i = 0; i < 300; ++i) {
    ASSERT_NEAR(surface.value(i, only), road.truth(i, only), 1e-4) << i;
    ASSERT_NEAR(surface.value(i, 0), road.truth(i, only), 1e-4) << i;
  }
}

}  // namespace
}  // namespace roadstereo
