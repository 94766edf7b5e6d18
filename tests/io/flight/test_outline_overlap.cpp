// Overlap of outlines on the road.
#include <gtest/gtest.h>

#include "io/flight/outline_overlap.hpp"

namespace roadstereo::io {
namespace {

// Squares, a triangle and an L, whose overlaps are known.
TEST(OutlineOverlap, IsShareOfSmallerPolygon) {
  const auto square = [](double x, double y, double side) {
    return Outline{{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
  };
  EXPECT_DOUBLE_EQ(outline_overlap(square(0, 0, 1), square(0.75, 0, 1)), 0.25);
  EXPECT_DOUBLE_EQ(outline_overlap(square(0, 0, 1), square(0.5, 0.5, 1)), 0.25);
  EXPECT_DOUBLE_EQ(outline_overlap(square(-5, -5, 10), square(0, 0, 1)), 1);
  EXPECT_EQ(outline_overlap(square(0, 0, 1), square(1, 0, 1)), 0);
  EXPECT_EQ(outline_overlap(square(0, 0, 1), square(0, 2, 1)), 0);
  EXPECT_NEAR(outline_overlap({{0, 0}, {1, 0}, {0, 1}}, square(0, 0, 0.5)), 1, 1e-12);
  EXPECT_NEAR(outline_overlap({{0, 0}, {1, 0}, {0, 1}}, square(0.5, 0.5, 1)), 0, 1e-12);
  const Outline corner{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
  EXPECT_NEAR(outline_overlap(corner, square(1, 1, 2)), 0, 1e-12) << "beside its inner corner";
  EXPECT_NEAR(outline_overlap(corner, square(0, 0, 3)), 1, 1e-12);
  EXPECT_EQ(outline_overlap({}, square(0, 0, 1)), 0);
  EXPECT_EQ(outline_overlap({{0, 0}, {1, 0}}, square(0, 0, 1)), 0);
}

}  // namespace
}  // namespace roadstereo::io
