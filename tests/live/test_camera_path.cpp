#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "live/camera_path.hpp"

namespace roadstereo::cli {
namespace {

TEST(CameraPath, IsBoundedAndEvenlyThinned) {
  constexpr int frames = 10000;
  constexpr double radius_m = 50;
  CameraPath path;
  std::size_t most = 0;
  for (int i = 0; i <= frames; ++i) {
    const double angle = 2 * std::numbers::pi * i / frames;
    path.add(radius_m * std::sin(angle), radius_m * (1 - std::cos(angle)));
    most = std::max(most, path.points_m().size());
  }
  EXPECT_LE(most, CameraPath::max_points + 1);
  EXPECT_NEAR(path.length_m(), 2 * std::numbers::pi * radius_m, 1e-3);
  const std::vector<std::array<double, 2>> points = path.points_m();
  EXPECT_EQ(points.front(), (std::array{0.0, 0.0}));
  EXPECT_NEAR(std::hypot(points.back()[0], points.back()[1]), 0, 1e-9);
  double longest = 0, shortest = INFINITY;
  for (std::size_t i = 2; i + 1 < points.size(); ++i) {
    const double step = std::hypot(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1]);
    longest = std::max(longest, step);
    shortest = std::min(shortest, step);
  }
  EXPECT_GT(points.size(), CameraPath::max_points / 4);
  EXPECT_LT(longest, 2.1 * shortest);
}

TEST(CameraPath, EndsAtLastPosition) {
  CameraPath path;
  EXPECT_TRUE(path.points_m().empty());
  path.add(1, 2);
  path.add(1.001, 2);
  path.add(1.002, 2);
  EXPECT_EQ(path.points_m(), (std::vector<std::array<double, 2>>{{1, 2}, {1.002, 2}}));
  EXPECT_NEAR(path.length_m(), 0.002, 1e-12);
  path.clear();
  path.add(5, 5);
  EXPECT_EQ(path.points_m().size(), 1U);
  EXPECT_EQ(path.length_m(), 0);
}

}  // namespace
}  // namespace roadstereo::cli
