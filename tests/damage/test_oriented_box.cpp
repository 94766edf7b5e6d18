// The smallest rectangle around points, against closed forms.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "damage/oriented_box.hpp"

namespace roadstereo {
namespace {

constexpr double degree = std::numbers::pi / 180;
using Points = std::vector<std::array<double, 2>>;

/// Points along the sides of a rectangle and within it.
Points rectangle(double length, double width, double angle) {
  Points points;
  for (const double a : {-0.5, -0.3, 0.0, 0.25, 0.5}) {
    for (const double b : {-0.5, -0.1, 0.2, 0.5}) {
      const double x = a * length, y = b * width;
      points.push_back({3 + std::cos(angle) * x - std::sin(angle) * y, -2 + std::sin(angle) * x + std::cos(angle) * y});
    }
  }
  return points;
}

TEST(OrientedBox, RecoversRectangleAtEveryAngle) {
  for (int k = -178; k <= 180; k += 2) {
    const OrientedBox box = oriented_box(rectangle(3, 1.25, k * degree));
    EXPECT_NEAR(box.length, 3, 1e-9) << k;
    EXPECT_NEAR(box.width, 1.25, 1e-9) << k;
    EXPECT_LE(std::abs(box.angle_rad), std::numbers::pi / 2 + 1e-12) << k;
    EXPECT_NEAR(std::sin(box.angle_rad - k * degree), 0, 1e-9) << k << ": the same line";
  }
}

/// One side of the smallest rectangle lies on a side of the triangle: all three have twice its area; the shortest
/// perimeter is not what is asked for.
TEST(OrientedBox, TriangleHasBoxOfTwiceItsArea) {
  const OrientedBox box = oriented_box({{0, 0}, {4, 0}, {1, 2}});
  EXPECT_NEAR(box.length * box.width, 8, 1e-12);
}

TEST(OrientedBox, CircleHasBoxOfItsDiameter) {
  Points points;
  for (int k = 0; k < 720; ++k) points.push_back({2 * std::cos(k * degree / 2), 2 * std::sin(k * degree / 2)});
  const OrientedBox box = oriented_box(points);
  EXPECT_NEAR(box.length, 4, 1e-4);
  EXPECT_NEAR(box.width, 4, 1e-4);
}

TEST(OrientedBox, HandlesPointsAndLines) {
  for (const Points& points : {Points{}, Points{{3, 4}}, Points{{3, 4}, {3, 4}, {3, 4}}}) {
    const OrientedBox box = oriented_box(points);
    EXPECT_EQ(box.length, 0);
    EXPECT_EQ(box.width, 0);
    EXPECT_EQ(box.angle_rad, 0);
  }
  for (const Points& line : {Points{{0, 0}, {3, 4}}, Points{{1.5, 2}, {3, 4}, {0, 0}, {0.75, 1}}}) {
    const OrientedBox box = oriented_box(line);
    EXPECT_NEAR(box.length, 5, 1e-12);
    EXPECT_NEAR(box.width, 0, 1e-12);
    EXPECT_NEAR(box.angle_rad, std::atan2(4, 3), 1e-12);
  }
  const OrientedBox upright = oriented_box({{1, 5}, {1, -1}, {1, 2}});
  EXPECT_NEAR(upright.length, 6, 1e-12);
  EXPECT_NEAR(std::abs(upright.angle_rad), std::numbers::pi / 2, 1e-12);
}

}  // namespace
}  // namespace roadstereo
