// What outlines cover together.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "io/flight/outline_union.hpp"

namespace roadstereo::io {
namespace {

/// A rectangle between two distances along a direction, and between two across it to the left.
Outline rectangle(double angle_rad, const std::array<double, 2>& along_m, const std::array<double, 2>& across_m) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const auto corner = [&](double x, double y) { return std::array{x * c - y * s, x * s + y * c}; };
  return {corner(along_m[0], across_m[0]), corner(along_m[1], across_m[0]), corner(along_m[1], across_m[1]),
          corner(along_m[0], across_m[1])};
}

// 3 m and another 3 m, of which 1 m is the same, of a strip 0.4 m wide: 5 m, 2 m².
TEST(OutlineUnion, CountsCommonPartsOnce) {
  for (const double angle_rad : {0.0, 0.5, 1.57, 2.5}) {
    OutlineUnion covered;
    covered.add(rectangle(angle_rad, {10, 13}, {-0.2, 0.2}));
    EXPECT_NEAR(covered.area_m2(), 1.2, 0.05) << angle_rad;
    covered.add(rectangle(angle_rad, {12, 15}, {-0.2, 0.2}));
    covered.add(rectangle(angle_rad, {10.5, 14}, {-0.1, 0.1}));
    EXPECT_NEAR(covered.area_m2(), 2, 0.05) << angle_rad;
    const std::array<double, 2> axis = covered.axis();
    EXPECT_NEAR(std::abs(axis[0] * std::cos(angle_rad) + axis[1] * std::sin(angle_rad)), 1, 1e-4) << angle_rad;
    EXPECT_NEAR(covered.extent_m({std::cos(angle_rad), std::sin(angle_rad)}), 5, 1e-9) << angle_rad;
    EXPECT_NEAR(covered.extent_m({-std::sin(angle_rad), std::cos(angle_rad)}), 0.4, 1e-9) << angle_rad;
  }
}

TEST(OutlineUnion, OfNothingHasNoExtent) {
  OutlineUnion covered;
  EXPECT_EQ(covered.area_m2(), 0);
  EXPECT_EQ(covered.extent_m(covered.axis()), 0);
  covered.add({{1, 2}, {1.004, 2}, {1.004, 4}});
  EXPECT_EQ(covered.area_m2(), 0) << "between the centres of cells";
  EXPECT_NEAR(covered.extent_m({0, 1}), 2, 1e-12);
}

}  // namespace
}  // namespace roadstereo::io
