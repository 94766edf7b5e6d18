// Straightedges on profiles with known gaps.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mapping/forward_path.hpp"
#include "roadstereo/road_profile.hpp"

namespace roadstereo {
namespace {

// A rut with the cross-section of a circle's chord: a straightedge as long as the chord rests on its ends.
std::vector<double> rut(double width_m, double depth_m, double spacing_m) {
  std::vector<double> heights;
  for (double x = -1.5; x <= 1.5 + 1e-9; x += spacing_m) {
    const double share = 2 * x / width_m;
    heights.push_back(std::abs(share) < 1 ? -depth_m * (1 - share * share) : 0.0);
  }
  return heights;
}

TEST(StraightedgeGap, IsDepthOfRutNarrowerThanStraightedge) {
  EXPECT_NEAR(straightedge_gap(rut(0.8, 0.012, 0.05), 0.05, 2), 0.012, 1e-9);
  std::vector<double> inclined = rut(0.8, 0.012, 0.05);
  for (std::size_t i = 0; i < inclined.size(); ++i) inclined[i] += 0.03 * 0.05 * static_cast<double>(i);
  EXPECT_NEAR(straightedge_gap(inclined, 0.05, 2), 0.012, 1e-9);
}

// Below a chord of length L of the parabola z = d·(2x/w)² lies d·(L/w)².
TEST(StraightedgeGap, IsSagittaUnderShortStraightedge) {
  EXPECT_NEAR(straightedge_gap(rut(3.2, 0.02, 0.05), 0.05, 1), 0.02 * (1 / 3.2) * (1 / 3.2), 1e-6);
}

TEST(StraightedgeGap, IsNoneOnFlatAndConvexRoads) {
  std::vector<double> crown;
  for (double x = -1.5; x <= 1.5; x += 0.1) crown.push_back(-0.01 * x * x);
  EXPECT_NEAR(straightedge_gap(crown, 0.1, 2), 0, 1e-12);
  EXPECT_EQ(straightedge_gap(std::vector<double>{1, 2}, 0.1, 2), 0);
}

TEST(StraightedgeGap, SkipsHeightsThatAreMissing) {
  std::vector<double> heights = rut(0.8, 0.012, 0.05);
  for (std::size_t i = 3; i < 6; ++i) heights[i] = NAN;
  EXPECT_NEAR(straightedge_gap(heights, 0.05, 2), 0.012, 1e-9);
}

// Of three heights of variance 1 the middle one lies z = (a + b)/2 − c below the others with variance 3/2; the mean of
// its positive part is √(3/2)/√(2π).
TEST(StraightedgeNoiseGap, OfThreeHeightsIsKnown) {
  EXPECT_NEAR(straightedge_noise_gap(3, 0.1, 0.2), std::sqrt(1.5 / (2 * 3.14159265)), 0.12);
}

std::vector<std::array<double, 2>> drive(const std::vector<double>& stops_m) {
  std::vector<std::array<double, 2>> path{{stops_m[0], 0}};
  for (std::size_t k = 1; k < stops_m.size(); ++k) {
    const int steps = static_cast<int>(std::lround(std::abs(stops_m[k] - stops_m[k - 1]) / 0.1));
    for (int i = 1; i <= steps; ++i) path.push_back({stops_m[k - 1] + (stops_m[k] - stops_m[k - 1]) * i / steps, 0});
  }
  return path;
}

TEST(ForwardPaths, GoOnAfterBackingUp) {
  const auto parts = forward_paths(drive({0, 2, 1.4, 6}));
  ASSERT_EQ(parts.size(), 1U);
  ASSERT_EQ(parts[0].size(), 61U);
  for (std::size_t i = 0; i < parts[0].size(); ++i) EXPECT_NEAR(parts[0][i][0], 0.1 * static_cast<double>(i), 1e-9);
}

TEST(ForwardPaths, BeginAnewAfterTurn) {
  const auto parts = forward_paths(drive({0, 12, 3}));
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].size(), 121U);
  EXPECT_EQ(parts[1].size(), 90U);  // but for the turning point, which the first part has
  EXPECT_NEAR(parts[1].front()[0], 11.9, 1e-9);
  EXPECT_NEAR(parts[1].back()[0], 3, 1e-9);
}

/// Along a square that a camera turning on the spot describes, the chord of two metres is none.
TEST(ForwardPath, HasDirectionWhereItReturns) {
  const std::vector<std::array<double, 2>> square{{0, 0}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}, {0, 0}};
  const PathStation middle = ForwardPath(square).at(1.2);
  EXPECT_NEAR(middle.at_m[0], 0.3, 1e-12);
  EXPECT_NEAR(middle.at_m[1], 0.5, 1e-12);
  EXPECT_NEAR(middle.ahead[0], -1, 1e-12);
  EXPECT_NEAR(middle.ahead[1], 0, 1e-12);
  const std::vector<std::array<double, 2>> corner{{0, 0}, {3, 0}, {3, 3}};
  EXPECT_NEAR(ForwardPath(corner).at(3).ahead[0], std::sqrt(0.5), 1e-12);
}

TEST(ForwardPaths, OfNothingAndOfStandstill) {
  EXPECT_TRUE(forward_paths({}).empty());
  const std::vector<std::array<double, 2>> still(5, {1, 1});
  ASSERT_EQ(forward_paths(still).size(), 1U);
  EXPECT_EQ(forward_paths(still)[0].size(), 1U);
}

}  // namespace
}  // namespace roadstereo
