// Cost of heights above and below the road against the geometry of a plane.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "stereo/coarse/height_prior.hpp"

namespace roadstereo {
namespace {

constexpr int factor = 4;
constexpr float no_texture = 1;

/// Looking down from 2 m with f·b = 84 px·m, where the disparity of height h is 84 / (2 − h), less doffs.
PerspectiveShift looking_down(double disparity_offset_px) {
  PerspectiveShift shift;
  shift.camera_height_m = 2;
  shift.disparity_offset_px = disparity_offset_px;
  return shift;
}

double cost(const DistanceCost& prior, double height_m) {
  const double road = 84.0 / 2 / factor, away = std::abs(84 / (2 - height_m) / factor - road);
  return prior.weight * std::pow(std::min(away, double{prior.truncation}), 2);
}

TEST(HeightPrior, CostIsThatOfHeightInMetres) {
  for (const double doffs : {0.0, 30.0}) {
    const DistanceCost prior = HeightPrior(0.1, 100, looking_down(doffs), factor).at(42 - static_cast<float>(doffs), 1);
    // The disparity is not quite linear in the height: by h/2.
    EXPECT_NEAR(cost(prior, 0.001), std::pow(0.001 / 0.1, 2), 2e-7);
    EXPECT_NEAR(cost(prior, -0.05), std::pow(0.05 / 0.1, 2), 0.02);
    EXPECT_NEAR(cost(prior, 0.1), 1, 0.11);
  }
}

/// The same height costs the same below a camera at arm's length and one ten times as high: not the same pixels.
TEST(HeightPrior, PixelsNearCameraCostLess) {
  PerspectiveShift near, far;
  near.camera_height_m = 0.5;
  far.camera_height_m = 5;
  const DistanceCost of_near = HeightPrior(0.15, 1.5, near, factor).at(280, no_texture);
  const DistanceCost of_far = HeightPrior(0.15, 1.5, far, factor).at(280, no_texture);
  EXPECT_NEAR(of_far.weight / of_near.weight, 100, 1e-3);
  EXPECT_NEAR(of_near.truncation / of_far.truncation, 10, 1e-4);
}

TEST(HeightPrior, CostIsBoundedAndGrowsWithUncertainty) {
  const DistanceCost prior = HeightPrior(0.15, 1.5, looking_down(0), factor).at(42, no_texture);
  EXPECT_NEAR(cost(prior, 1.5), 1.5, 1e-5);
  const DistanceCost textured = HeightPrior(0.15, 1.5, looking_down(0), factor).at(42, 0.2F);
  EXPECT_NEAR(cost(textured, 1.5), 0.3, 1e-5);
  // A pixel at the horizon and behind it is no more than a metre.
  for (const float disparity : {0.0F, -5.0F, 1e-6F}) {
    const DistanceCost horizon = HeightPrior(0.15, 1.5, looking_down(0), factor).at(disparity, no_texture);
    EXPECT_NEAR(horizon.weight, std::pow(1 / 0.15, 2), 1e-3);
  }
}

TEST(HeightPrior, HeightOfZeroIsNoPrior) {
  const DistanceCost prior = HeightPrior(0, 1.5, looking_down(0), factor).at(42, no_texture);
  EXPECT_EQ(prior.weight, 0);
  EXPECT_EQ(cost(prior, 0.1), 0);
}

}  // namespace
}  // namespace roadstereo
