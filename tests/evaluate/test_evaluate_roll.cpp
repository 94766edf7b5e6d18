// What the experiments on roll and flatness are made of, against closed forms on planes.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "evaluate/lambda_sweep.hpp"
#include "evaluate/road_flatness.hpp"
#include "evaluate/roll_maps.hpp"
#include "evaluate/roll_trials.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

constexpr int width = 81, height = 61;

Image<float> plane_map(const DisparityPlane& plane) {
  Image<float> map(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) map(u, v) = static_cast<float>(plane.disparity(u, v));
  }
  return map;
}

/// d = 20 + 0.25·(v − centre) turned by ψ about the centre is 20 + 0.25·((v − centre)·cos ψ − (u − centre)·sin ψ).
double rotated_truth(int u, int v, double roll) {
  return 20 + 0.25 * ((v - (height - 1) / 2.0) * std::cos(roll) - (u - (width - 1) / 2.0) * std::sin(roll));
}

const DisparityPlane level{20 - 0.25 * (height - 1) / 2.0, 0.25, 0};

TEST(RotateMap, GivesPlaneRequestedRoll) {
  for (const double roll : {-0.35, -0.01, 0.2}) {
    const Image<float> smooth = rotate_map(plane_map(level), roll, Resampling::bilinear);
    const Image<float> coarse = rotate_map(plane_map(level), roll, Resampling::nearest);
    int valid = 0;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        if (std::isnan(smooth(u, v))) continue;
        ++valid;
        EXPECT_NEAR(smooth(u, v), rotated_truth(u, v, roll), 1e-4);
        EXPECT_NEAR(coarse(u, v), rotated_truth(u, v, roll), 0.25 * 0.5 + 1e-4);  // half a row away at most
      }
    }
    EXPECT_GT(valid, width * height / 2);
  }
}

TEST(RotateMap, QuarterTurnMovesWholePixels) {
  Image<float> map = plane_map({0, 0, 0});
  map((width - 1) / 2 + 10, (height - 1) / 2) = 7;  // right of the centre
  const Image<float> turned = rotate_map(map, std::acos(-1.0) / 2, Resampling::nearest);
  EXPECT_EQ(turned((width - 1) / 2, (height - 1) / 2 + 10), 7);  // now below it: clockwise as one sees it
  EXPECT_TRUE(std::isnan(turned(0, 0)));
}

TEST(AddOutliers, ChangesRequestedShareOfValidPixels) {
  Image<float> map(400, 300, 12.0F);
  map(5, 5) = NAN;
  map(399, 299) = 50;
  Image<float> again = map;
  add_outliers(map, 0.05, 3);
  add_outliers(again, 0.05, 3);
  double spoilt = 0, sum = 0;
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) {
      if (std::isnan(map(u, v)) || map(u, v) == 12.0F) continue;
      EXPECT_EQ(map(u, v), again(u, v));
      EXPECT_LE(map(u, v), 50);
      spoilt += 1;
      sum += map(u, v);
    }
  }
  EXPECT_TRUE(std::isnan(map(5, 5)));
  EXPECT_NEAR(spoilt / static_cast<double>(map.pixels()), 0.05, 0.003);  // five standard deviations
  EXPECT_NEAR(sum / spoilt, 25, 1);
}

TEST(SlowRollTrials, PairWithoutRoadIsNoEstimate) {
  RollTrialOptions options;
  options.angles = 1;
  options.methods.settings = {"road_model.min_evidence=1"};
  for (const RollErrors& errors : run_matched_trials(options)) {
    EXPECT_EQ(errors.lost, 3) << errors.maps;
    EXPECT_TRUE(errors.error_rad.empty());
    EXPECT_TRUE(std::isnan(errors.max_rad()));
  }
}

TEST(LambdaSweep, ValuesHaveEqualRatios) {
  const std::vector<double> values = geometric_series(0.01, 10000, 7);
  ASSERT_EQ(values.size(), 7U);
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(values[i] / std::pow(10, static_cast<double>(i) - 2), 1, 1e-12);
  }
}

TEST(LambdaSweep, BestIsMiddleOfTies) {
  EXPECT_NEAR(best_lambda({{1, {5, 7}, 0}, {10, {3, 4}, 0}, {1000, {4, 3}, 0}, {1e4, {3, 5}, 0}}), 100, 1e-9);
}

TEST(LambdaSweep, EveryRateReachesRollOfPlane) {
  const std::vector<LambdaMap> maps{{plane_map({20, 0.25, -0.02}), std::atan(0.02 / 0.25)}};
  for (const double lambda : {0.01, 10.0, 1e4}) {
    const LambdaTrial trial = run_lambda_trial(lambda, maps, 1e-8, 1);
    EXPECT_LT(trial.max_error_rad, 1e-6) << lambda;
    EXPECT_EQ(trial.iterations.size(), 1U);
  }
}

// On a plane with roll the row tells all but a2·u, which is uniform over the columns: σ_d = |a2|·√((w² − 1)/12).
TEST(Flatness, WithoutRollColumnsSpread) {
  const DisparityPlane rolled{3, 0.2, -0.05};
  const Image<float> map = plane_map(rolled);
  const Image<std::uint8_t> mask(width, height, 255);
  const DisparityPlane line = fit_without_roll(map, mask);
  EXPECT_NEAR(line.a1, 0.2, 1e-6);
  EXPECT_NEAR(line.a0, 3 - 0.05 * (width - 1) / 2.0, 1e-5);
  EXPECT_EQ(line.a2, 0);
  EXPECT_NEAR(transformed_deviation(map, mask, line), 0.05 * std::sqrt((width * width - 1) / 12.0), 1e-5);
  EXPECT_NEAR(transformed_deviation(map, mask, rolled), 0, 1e-6);
}

TEST(Flatness, UsesValidMaskedPixelsOnly) {
  Image<float> map = plane_map(level);
  Image<std::uint8_t> mask(width, height, 255);
  map(3, 3) = 100;
  mask(3, 3) = 0;
  map(4, 4) = NAN;
  EXPECT_NEAR(fit_without_roll(map, mask).a1, 0.25, 1e-6);
  EXPECT_NEAR(transformed_deviation(map, mask, level), 0, 1e-5);
}

TEST(Flatness, RejectsSingleRow) {
  const Image<float> map = plane_map(level);
  Image<std::uint8_t> mask(width, height, 0);
  for (int u = 0; u < width; ++u) mask(u, 7) = 255;
  EXPECT_THROW(fit_without_roll(map, mask), Error);
  EXPECT_TRUE(std::isnan(transformed_deviation(map, Image<std::uint8_t>(width, height, 0), level)));
}

}  // namespace
}  // namespace roadstereo::cli
