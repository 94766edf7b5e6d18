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
constexpr std::array<int, 8> pattern{0, 1, -1, 1, 0, -1, 1, -1};  // of stripes 8 wide: median 0, MAD 1

/// A square `difference` standard deviations darker than the road, and right of it a strip of its median tone, or
/// `strip` standard deviations above that.
Image<std::int16_t> dark_square(double difference, double strip = 0) {
  Image<std::int16_t> grey(side, side);
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      const bool in_rows = v >= first && v <= last;
      const bool inside = in_rows && u >= first && u <= last;
      const bool in_strip = in_rows && u > last && u <= last + strip_columns;
      const double noise = deviation * pattern[static_cast<std::size_t>(u / 8 % 8)];
      const double level = inside     ? road_level - difference * sigma + noise
                           : in_strip ? road_level + (strip - difference) * sigma
                                      : road_level + noise;
      grey(u, v) = static_cast<std::int16_t>(std::lround(level));
    }
  }
  return grey;
}

/// Cells of the strip that join the square, of those whose 3×3 mean is the strip's level.
int joined(const Image<std::int16_t>& grey, int& all) {
  BoxMask region(CellBox{first, first, last, last});
  for (int j = first; j <= last; ++j) {
    for (int i = first; i <= last; ++i) region.set(i, j);
  }
  refine_outline_by_image({grey, 1, radius}, side, side, region);
  int count = 0;
  all = 0;
  for (int j = first + 1; j < last; ++j) {
    for (int i = last + 2; i < last + strip_columns; ++i) {
      ++all;
      count += region(i, j) ? 1 : 0;
    }
  }
  return count;
}

// At the median inside the log of the likelihood ratio is ½ d², d the difference of the tones in standard
// deviations: 1.5 at √3.
TEST(ImageOutline, GrowsWhereTonesDifferByMoreThanRootThree) {
  int all = 0;
  EXPECT_EQ(joined(dark_square(2), all), all);
  EXPECT_EQ(joined(dark_square(-2), all), all);  // brighter than the road
  EXPECT_EQ(joined(dark_square(1.45), all), 0);
}

// Elsewhere it is d (d/2 − x), x standard deviations above that median: with d = 4 it is 1.5 at 1.625.
TEST(ImageOutline, GrowsLessTowardsToneOfRoad) {
  int all = 0;
  EXPECT_EQ(joined(dark_square(4, 1.4), all), all);
  EXPECT_EQ(joined(dark_square(4, 2.1), all), 0);
}

TEST(ImageOutline, NeverGrowsBeyondOtherSideOfRoad) {
  int all = 0;
  EXPECT_EQ(joined(dark_square(4, 12), all), 0);
}

TEST(ImageOutline, EqualTonesChangeNothing) {
  int all = 0;
  EXPECT_EQ(joined(Image<std::int16_t>(side, side, std::int16_t{800}), all), 0);
}

}  // namespace
}  // namespace roadstereo
