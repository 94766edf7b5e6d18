// Roll and projection model on exact maps: all three solvers, with damage and outliers, straight down, and the
// transformed map.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "roadstereo/error.hpp"
#include "roadstereo/roll.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Image<float> road_map(double roll, double alpha0, double alpha1, int width = 320, int height = 180) {
  Image<float> map(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      map(u, v) = static_cast<float>(alpha0 + alpha1 * (v * std::cos(roll) - u * std::sin(roll)));
    }
  }
  return map;
}

/// A pothole, a vehicle, 5 % outliers and missing pixels.
void damage(Image<float>& map) {
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) {
      if (std::hypot(u - 220, v - 120) < 30) map(u, v) -= 4;
      if (u > 20 && u < 90 && v > 10 && v < 60) map(u, v) = 40;
      const double chance = test::lattice(u, v, 11);
      if (chance < 0.05) map(u, v) = static_cast<float>(60 * test::lattice(u, v, 12));
      if (chance > 0.9) map(u, v) = nan;
    }
  }
}

RollOptions with(RollSolver solver) {
  RollOptions options;
  options.solver = solver;
  return options;
}

class RoadGeometrySolver : public testing::TestWithParam<RollSolver> {};

TEST_P(RoadGeometrySolver, RecoversRollAndModelOfExactRoad) {
  for (const double degrees : {-20.0, -5.0, -0.3, 0.0, 1.0, 8.0, 20.0}) {
    const double roll = degrees * M_PI / 180;
    const RollEstimate g = estimate_roll(road_map(roll, 20, 0.15), {}, std::nullopt, 0, with(GetParam()));
    EXPECT_NEAR(g.roll_rad, roll, 2e-6) << degrees;
    EXPECT_NEAR(g.alpha0, 20, 1e-3);
    EXPECT_NEAR(g.alpha1, 0.15, 1e-5);
    EXPECT_NEAR(g.plane.a1, 0.15 * std::cos(roll), 1e-5);
    EXPECT_NEAR(g.plane.a2, -0.15 * std::sin(roll), 1e-5);
    EXPECT_TRUE(g.roll_observable);
    EXPECT_LT(g.residual_px, 1e-4);
  }
}

TEST_P(RoadGeometrySolver, RollIsInHalfOpenInterval) {
  for (const double roll : {-1.5, 1.5, M_PI / 2}) {
    const RollEstimate g = estimate_roll(road_map(roll, 60, 0.1), {}, std::nullopt, 0, with(GetParam()));
    EXPECT_GT(g.roll_rad, -M_PI / 2);
    EXPECT_LE(g.roll_rad, M_PI / 2);
    // Modulo π the same line: 0 and π are one angle, the sign of α1 tells them apart.
    EXPECT_NEAR(std::remainder(g.roll_rad - roll, M_PI), 0, 1e-5);
  }
}

TEST_P(RoadGeometrySolver, RollIsNotObservableAtNadir) {
  Image<float> map(320, 180);
  for (int v = 0; v < 180; ++v) {
    for (int u = 0; u < 320; ++u) map(u, v) = static_cast<float>(21 + 0.1 * (test::lattice(u, v, 4) - 0.5));
  }
  const RollEstimate g = estimate_roll(map, {}, std::nullopt, 0, with(GetParam()));
  EXPECT_FALSE(g.roll_observable);
  EXPECT_NEAR(g.plane.disparity(160, 90), 21, 0.01);
  Image<float> transformed;
  const double delta_t = transform_disparity(map, g, 5, with(GetParam()), 1, transformed);
  EXPECT_NEAR(transformed(160, 90), delta_t, 0.1);
}

TEST_P(RoadGeometrySolver, RejectsLine) {
  Image<float> empty(100, 50, nan);
  EXPECT_THROW(estimate_roll(empty, {}, std::nullopt, 0, with(GetParam())), Error);
  for (int u = 0; u < 100; ++u) empty(u, 20) = 5;
  EXPECT_THROW(estimate_roll(empty, {}, std::nullopt, 0, with(GetParam())), Error);
}

TEST_P(RoadGeometrySolver, IgnoresMaskedPixels) {
  Image<float> map = road_map(0.05, 10, 0.2);
  Image<std::uint8_t> mask(320, 180, 255);
  for (int v = 0; v < 180; ++v) {
    for (int u = 0; u < 100; ++u) {
      map(u, v) += 50;
      mask(u, v) = 0;
    }
  }
  const RollEstimate g = estimate_roll(map, mask.view(), std::nullopt, 0, with(GetParam()));
  EXPECT_NEAR(g.roll_rad, 0.05, 2e-6);
  Image<std::uint8_t> other(10, 10);
  EXPECT_THROW(estimate_roll(map, other.view(), std::nullopt, 0, with(GetParam())), Error);
}

std::string solver_name(const testing::TestParamInfo<RollSolver>& test) {
  if (test.param == RollSolver::robust) return "robust";
  return test.param == RollSolver::closed_form ? "closed_form" : "gradient_descent";
}

INSTANTIATE_TEST_SUITE_P(Solvers, RoadGeometrySolver,
                         testing::Values(RollSolver::gradient_descent, RollSolver::closed_form, RollSolver::robust),
                         solver_name);

TEST(RollEstimate, DescentMatchesClosedFormOnDamagedMaps) {
  for (const double roll : {-0.3, -0.02, 0.0, 0.11, 0.35}) {
    Image<float> map = road_map(roll, 20, 0.15);
    damage(map);
    const RollEstimate a = estimate_roll(map, {}, std::nullopt, 0, with(RollSolver::gradient_descent));
    const RollEstimate b = estimate_roll(map, {}, std::nullopt, 0, with(RollSolver::closed_form));
    EXPECT_NEAR(a.roll_rad, b.roll_rad, 1e-6);
    EXPECT_NEAR(a.alpha0, b.alpha0, 1e-4);
    EXPECT_NEAR(a.alpha1, b.alpha1, 1e-8);
  }
}

TEST(RollEstimate, RobustIgnoresDamageVehiclesAndOutliers) {
  for (const double roll : {-0.3, -0.02, 0.0, 0.11, 0.35}) {
    Image<float> map = road_map(roll, 30, 0.15);
    damage(map);
    const RollEstimate robust = estimate_roll(map, {}, std::nullopt, 0, with(RollSolver::robust));
    EXPECT_NEAR(robust.roll_rad, roll, 2e-4);
    const RollEstimate plain = estimate_roll(map, {}, std::nullopt, 0, with(RollSolver::closed_form));
    EXPECT_GT(std::abs(plain.roll_rad - roll), 1e-3);  // the data would pull a solver that let it
  }
}

// The standard error must cover the scatter of the estimate under noise that is correlated over 8 pixels, which a
// formula for independent pixels understates eightfold.
TEST(RollEstimate, StandardErrorCoversCorrelatedNoise) {
  double squares = 0, claimed = 0;
  constexpr int trials = 40;
  for (int trial = 0; trial < trials; ++trial) {
    Image<float> map = road_map(0.03, 20, 0.15);
    for (int v = 0; v < 180; ++v) {
      for (int u = 0; u < 320; ++u) {
        map(u, v) += static_cast<float>(test::lattice(u / 8, v / 8, 100 + static_cast<std::uint64_t>(trial)) - 0.5);
      }
    }
    const RollEstimate g = estimate_roll(map, {}, std::nullopt, 0, with(RollSolver::closed_form));
    squares += (g.roll_rad - 0.03) * (g.roll_rad - 0.03);
    claimed += g.roll_stderr_rad;
  }
  const double scatter = std::sqrt(squares / trials);
  EXPECT_GT(claimed / trials, 0.6 * scatter);
  EXPECT_LT(claimed / trials, 1.6 * scatter);
}

// A road with a bend across its direction has one slope at each place. Wherever its crown lies in view or beside it,
// the roll at the crown is within two standard errors; the noise alone would claim a fiftieth of that.
TEST(RollEstimate, StandardErrorCoversCamber) {
  for (const double crown : {60.0, 160.0, 240.0}) {
    Image<float> map = road_map(0.03, 20, 0.15);
    for (int v = 0; v < 180; ++v) {
      for (int u = 0; u < 320; ++u) {
        const double noise = test::lattice(u, v, 7) - 0.5;
        map(u, v) += static_cast<float>(-2e-5 * (u - crown) * (u - crown) + 0.2 * noise);
      }
    }
    for (const RollSolver solver : {RollSolver::closed_form, RollSolver::robust}) {
      const RollEstimate g = estimate_roll(map, {}, std::nullopt, 0, with(solver));
      EXPECT_LT(std::abs(g.roll_rad - 0.03), 2 * g.roll_stderr_rad) << "crown at " << crown;
      // The slope bends by 2·2e-5 a pixel; over 320 columns its standard deviation is that times 320/√12.
      EXPECT_NEAR(g.roll_stderr_rad, 2 * 2e-5 * 320 / std::sqrt(12.0) / 0.15, 2e-3);
    }
  }
}

TEST(TransformDisparity, RoadIsFlatAndDamageKeepsDepth) {
  Image<float> map = road_map(0.1, 25, 0.2);
  map(160, 90) -= 3;
  map(10, 10) = nan;
  const RollEstimate g = estimate_roll(map, {}, std::nullopt, 0, with(RollSolver::robust));
  Image<float> transformed;
  const double delta_t = transform_disparity(map, g, 2, with(RollSolver::robust), 2, transformed);
  EXPECT_EQ(delta_t, 4);  // the smallest whole number that keeps the damage, 3 px below, positive
  EXPECT_NEAR(transformed(30, 100), 4, 1e-3);
  EXPECT_NEAR(transformed(300, 20), 4, 1e-3);
  EXPECT_NEAR(transformed(160, 90), 1, 1e-3);
  EXPECT_TRUE(std::isnan(transformed(10, 10)));
  RollOptions fixed;
  fixed.delta_t_px = 30;
  EXPECT_EQ(transform_disparity(map, g, 2, fixed, 2, transformed), 30);
  EXPECT_NEAR(transformed(160, 90), 27, 1e-3);
}

TEST(TransformDisparity, RefusesEmptyMapAndOptionsOutOfRange) {
  Image<float> transformed;
  EXPECT_THROW(transform_disparity(Image<float>(), RollEstimate{}, 2, RollOptions{}, 1, transformed), Error);
  RollOptions options;
  options.delta_t_px = 10001;
  EXPECT_THROW(transform_disparity(Image<float>(8, 4, 5), RollEstimate{}, 2, options, 1, transformed), Error);
}

TEST(RoadResiduals, IsStandardDeviation) {
  Image<float> map(100, 100, 10);
  for (int v = 0; v < 100; ++v) {
    for (int u = 0; u < 100; ++u) map(u, v) += (u + v) % 2 == 0 ? 0.25F : -0.25F;
  }
  for (int u = 0; u < 100; ++u) map(u, 0) = 30;
  const RoadResiduals spread = measure_residuals(map, 10);
  EXPECT_NEAR(spread.sigma_road_px, 0.25, 1e-3);
  EXPECT_NEAR(spread.road_share, 0.99, 1e-9);
  // 99 % at ±0.25 around 10 and 1 % at 30: variance 0.99·0.0625 + 0.99·0.01·400
  EXPECT_NEAR(spread.sigma_all_px, std::sqrt(0.99 * 0.0625 + 0.99 * 0.01 * 400), 1e-3);
}

TEST(RollOptions, RejectsValuesOutOfRange) {
  RollOptions options;
  options.initial_lambda = 0;
  EXPECT_THROW(options.validate(), Error);
  options = {};
  options.roll_threshold_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(options.validate(), Error);
}

/// A pavement beside the road, 1.4 px above it, with the noise of matching. The plane known before matching leans
/// against the kerb, half a pixel off.
TEST(RoadGeometry, PavementDoesNotTiltRoad) {
  for (const int road_columns : {280, 200, 150}) {
    Image<float> map = road_map(0.02, 20, 0.15);
    for (int v = 0; v < map.height(); ++v) {
      for (int u = 0; u < map.width(); ++u) {
        map(u, v) += static_cast<float>(0.1 * (test::lattice(u, v, 21) + test::lattice(u, v, 22) - 1));
        if (u >= road_columns) map(u, v) += 1.4F;
      }
    }
    const DisparityPlane leaning{19.9, 0.15 * std::cos(0.02), -0.15 * std::sin(0.02) + 0.006};
    const RollEstimate g = estimate_roll(map, {}, leaning, 0, RollOptions{});
    for (const int u : {0, road_columns}) {
      for (const int v : {0, 179}) {
        const double road = 20 + 0.15 * (v * std::cos(0.02) - u * std::sin(0.02));
        EXPECT_NEAR(g.plane.disparity(u, v), road, 0.02) << road_columns << " columns of road";
      }
    }
  }
}

/// Road on a sixth of the picture below a house front, as of a camera that looks up.
TEST(RoadGeometry, HouseFrontIsNoRoad) {
  constexpr int horizon = 120, first_road_row = 150;
  constexpr double front_px = 12, per_row = 0.4;
  Image<float> map(320, 180);
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) {
      const double exact = v < first_road_row ? front_px : per_row * (v - horizon);
      map(u, v) = static_cast<float>(exact + 0.2 * (test::lattice(u, v, 24) - 0.5));
    }
  }
  const RollEstimate g = estimate_roll(map, {}, DisparityPlane{-per_row * horizon + 0.4, per_row, 0.001}, 0, {});
  for (const int u : {0, 319}) {
    for (const int v : {first_road_row, 179}) EXPECT_NEAR(g.plane.disparity(u, v), per_row * (v - horizon), 0.03);
  }
}

/// The plane of a wavy road lies among the waves, lower than their middle, where the quantile is least.
TEST(RoadGeometry, WavyRoadHasPlaneBetweenTroughsAndCrests) {
  constexpr double amplitude = 0.3, noise = 0.05;
  Image<float> map = road_map(0.02, 20, 0.15);
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) {
      map(u, v) +=
          static_cast<float>(amplitude * std::sin(0.35 * v + 0.1 * u) + noise * (2 * test::lattice(u, v, 23) - 1));
    }
  }
  const RollEstimate g = estimate_roll(map, {}, std::nullopt, 0, RollOptions{});
  EXPECT_NEAR(g.roll_rad, 0.02, 0.002);
  for (const int u : {0, 319}) {
    for (const int v : {0, 179}) {
      const double middle = 20 + 0.15 * (v * std::cos(0.02) - u * std::sin(0.02));
      EXPECT_LT(g.plane.disparity(u, v), middle + 0.1 * amplitude);
      EXPECT_GT(g.plane.disparity(u, v), middle - amplitude - noise);
    }
  }
}

}  // namespace
}  // namespace roadstereo
