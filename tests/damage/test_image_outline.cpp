// Growth of an outline by grey levels, against the likelihood ratio of two normal distributions.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "damage/image_outline.hpp"

namespace roadstereo {
namespace {

constexpr int side = 160, first = 32, last = 95, strip_columns = 4, radius = 8;
constexpr double road_level = 1600, deviation = 32;               // 1/16 grey level
constexpr double sigma = 1.4826 * deviation;                      // of the pattern, by its MAD
constexpr std::array<int, 8> pattern{1, -1, 1, 0, -1, 1, -1, 0};  // of stripes 8 wide: median 0, MAD 1

/// A square whose median is `difference` standard deviations of the road below it and whose standard deviation is
/// `roughness` times the road's, and right of it a strip `strip` standard deviations of the road above that median.
struct Tones {
  double difference = 0, strip = 0, roughness = 1;
  bool shadow_beside = false;  ///< the road right of the square has its median
};

Image<std::int16_t> square_on_road(const Tones& tones) {
  Image<std::int16_t> grey(side, side);
  const double square_level = road_level - tones.difference * sigma;
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      const bool in_rows = v >= first && v <= last;
      const double noise = deviation * pattern[static_cast<std::size_t>(u / 8 % 8)];
      double level = (tones.shadow_beside && u > last ? square_level : road_level) + noise;
      if (in_rows && u >= first && u <= last) level = square_level + tones.roughness * noise;
      if (in_rows && u > last && u <= last + strip_columns) level = square_level + tones.strip * sigma;
      grey(u, v) = static_cast<std::int16_t>(std::lround(level));
    }
  }
  return grey;
}

/// Share of the cells of the strip that join the square, of those whose 3×3 mean is the strip's level.
double joined(const Image<std::int16_t>& grey, const Image<std::uint8_t>& hidden = Image<std::uint8_t>(side, side, 0),
              const BoxMask& other_hollows = {}) {
  BoxMask region(CellBox{first, first, last, last});
  for (int j = first; j <= last; ++j) {
    for (int i = first; i <= last; ++i) region.set(i, j);
  }
  refine_outline_by_image({grey, 1, radius}, hidden, other_hollows, radius, region);
  int count = 0, all = 0;
  for (int j = first + 1; j < last; ++j) {
    for (int i = last + 2; i < last + strip_columns; ++i) {
      ++all;
      count += region(i, j) ? 1 : 0;
    }
  }
  return static_cast<double>(count) / all;
}

// At the median inside the log of the likelihood ratio is ½ d², d the difference of the tones in standard
// deviations: 1.5 at √3 = 1.73.
TEST(ImageOutline, GrowsWhereTonesDifferByMoreThanRootThree) {
  EXPECT_EQ(joined(square_on_road({1.85})), 1);
  EXPECT_EQ(joined(square_on_road({-1.85})), 1);  // brighter than the road
  EXPECT_EQ(joined(square_on_road({1.6})), 0);
}

// Elsewhere it is d (d/2 − x), x standard deviations above that median: with d = 4 it is 1.5 at 1.625.
TEST(ImageOutline, GrowsLessTowardsToneOfRoad) {
  EXPECT_EQ(joined(square_on_road({4, 1.5})), 1);
  EXPECT_EQ(joined(square_on_road({4, 1.75})), 0);
}

// Inside r times as rough: at the median ½ d² − ln r; with r = 3 it is 1.5 at √(3 + 2 ln 3) = 2.28.
TEST(ImageOutline, RougherInsideNeedsMoreDifference) {
  EXPECT_EQ(joined(square_on_road({2.5, 0, 3})), 1);
  EXPECT_EQ(joined(square_on_road({2.05, 0, 3})), 0);
}

// The strip is brighter than the road by 6 standard deviations, which is likelier inside: 10/3 of the deviations there.
TEST(ImageOutline, NeverGrowsBeyondOtherSideOfRoad) {
  EXPECT_EQ(joined(square_on_road({4, 10, 3})), 0);
}

// A smoother inside: what is darker than all of it belongs to the hole, too.
TEST(ImageOutline, DarkerThanInsideJoins) {
  EXPECT_EQ(joined(square_on_road({4, -4, 0.25})), 1);
}

// A wall of another hollow across the strip: neither it nor what lies behind it joins.
TEST(ImageOutline, DoesNotCrossAnotherHollow) {
  BoxMask other_hollows(CellBox{last + 2, 0, last + 2, side - 1});
  for (int j = 0; j < side; ++j) other_hollows.set(last + 2, j);
  EXPECT_EQ(joined(square_on_road({4})), 1);
  EXPECT_EQ(joined(square_on_road({4}), Image<std::uint8_t>(side, side, 0), other_hollows), 0);
}

// The strip is as dark as the square, and so is all the road on that side.
TEST(ImageOutline, ShadowThatEndsAtTheHoleStays) {
  EXPECT_EQ(joined(square_on_road({4})), 1);
  EXPECT_EQ(joined(square_on_road({4, 0, 1, true})), 0);
}

// In that shadow the strip is darker by 4 standard deviations, 4/3 of those inside: the log of the ratio is
// ½ (16 − 16/9) − ln 3 = 6.
TEST(ImageOutline, DarkWallInShadowJoins) {
  EXPECT_EQ(joined(square_on_road({4, -4, 3, true})), 1);
}

// Dark arms of five cells reach from the dark square to the border.
TEST(ImageOutline, GrowsFewerRowsWhereRoadIsForeshortened) {
  constexpr int middle = (first + last) / 2;
  const auto in_arms = [](int at) { return std::abs(at - middle) <= 2; };
  const auto in_square = [](int at) { return at >= first && at <= last; };
  Image<std::int16_t> grey(side, side);
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      const bool is_dark = in_arms(u) || in_arms(v) || (in_square(u) && in_square(v));
      grey(u, v) = static_cast<std::int16_t>((is_dark ? 400 : 1600) + (u * 7 + v * 5) % 8);
    }
  }
  const Image<std::uint8_t> hidden(side, side, 0);
  for (const int rows : {1, 2, radius}) {
    BoxMask region(CellBox{first, first, last, last});
    for (int j = first; j <= last; ++j) {
      for (int i = first; i <= last; ++i) region.set(i, j);
    }
    refine_outline_by_image({grey, 1, radius}, hidden, BoxMask(), rows, region);
    EXPECT_TRUE(region(middle, last + rows) && region(middle, first - rows)) << rows;
    EXPECT_FALSE(region(middle, last + rows + 1) || region(middle, first - rows - 1)) << rows;
    EXPECT_TRUE(region(last + radius, middle) && region(first - radius, middle)) << rows;
    EXPECT_FALSE(region(last + radius + 1, middle)) << rows;
  }
}

TEST(ImageOutline, EqualTonesChangeNothing) {
  EXPECT_EQ(joined(Image<std::int16_t>(side, side, std::int16_t{800})), 0);
}

}  // namespace
}  // namespace roadstereo
