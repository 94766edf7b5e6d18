// Slopes of surfaces from noisy heights, against closed forms and pixel by pixel.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "road/refinement/row_slopes.hpp"
#include "road/refinement/slope.hpp"
#include "roadstereo/refinement.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

TEST(Slopes, HarmonicMeanOfBothSides) {
  const SlopeSettings settings{3, 10};
  // 0.3 px over 3 pixels before, 0.6 after: slopes of 0.1 and 0.2, whose harmonic mean is 2/15.
  const Slope slope = limited_slope(5.3F, {5.0F, 100.0F}, {5.9F, 50.0F}, settings);
  EXPECT_NEAR(slope.value, 2.0 / 15, 1e-6);
  // The difference of the boxes, 6 pixels apart, has the variance 10·(1/100 + 1/50).
  EXPECT_NEAR(slope.significance, std::pow(2.0 / 15, 2) / (0.3 / 36), 1e-4);
}

TEST(Slopes, NoneBesideAStepOnARidgeOrWithoutABox) {
  const SlopeSettings settings{3, 10};
  for (const auto& [before, after] : {std::pair{BoxMean{4, 100}, BoxMean{4.5F, 100}},     // the pixel is level with one
                                      std::pair{BoxMean{3.8F, 100}, BoxMean{3.9F, 100}},  // lower than it on both sides
                                      std::pair{BoxMean{0, 0}, BoxMean{4.5F, 100}}}) {
    const Slope slope = limited_slope(4, before, after, settings);
    EXPECT_EQ(slope.value, 0);
    EXPECT_EQ(slope.significance, 0);
  }
}

TEST(Slopes, NoiseAloneIsShrunkByAHalf) {
  EXPECT_FLOAT_EQ(slope_share({0.1F, 1}, {0.1F, 1}), 0.5F);
  EXPECT_FLOAT_EQ(slope_share({0.1F, 38}, {0, 0}), 0.95F);
  EXPECT_EQ(slope_share({0, 0}, {0, 0}), 0);
}

/// Rows of heights with gaps, with room on both sides, and boxes of three sizes: sums, means and slopes of vectors
/// against sums in double precision and `limited_slope`.
TEST(Slopes, RowsAreThoseOfPixels) {
  constexpr int width = 61, room = 40, columns = width + 2 * room;
  for (const int step : {1, 3, 8}) {
    const SlopeSettings settings{step, 10};
    const int rows = 4 * step - 1, middle = 2 * step - 1;
    Image<float> heights(columns, rows, 0.0F), precision(columns, rows, 0.0F);
    for (int y = 0; y < rows; ++y) {
      for (int u = 0; u < width; ++u) {
        const bool gap = test::lattice(u, y, 1) < 0.3;
        heights(room + u, y) = static_cast<float>(test::smooth_noise(u, y, 7, 2));
        precision(room + u, y) = gap ? 0.0F : static_cast<float>(1 + 9 * test::lattice(u, y, 3));
      }
    }
    const auto box = [&](int u, int v) {
      double sum = 0, weights = 0;
      for (int y = v - step + 1; y < v + step; ++y) {
        for (int x = room + u - step + 1; x < room + u + step; ++x) {
          sum += double{precision(x, y)} * heights(x, y);
          weights += precision(x, y);
        }
      }
      return box_mean(static_cast<float>(sum), static_cast<float>(weights));
    };
    Image<float> sums(columns, 2 * rows, 0.0F), boxes(columns, 6, 0.0F), slopes(columns, 2, 0.0F);
    const auto row_of = [](Image<float>& numbers, int y) {
      return BoxRow{numbers.row(2 * y) + room, numbers.row(2 * y + 1) + room};
    };
    for (int y = 0; y < rows; ++y) {
      sum_columns({heights.row(y) + room, precision.row(y) + room}, step - 1, -step, width + step, row_of(sums, y));
    }
    const std::ptrdiff_t pitch = sums.row(2) - sums.row(0);
    for (int k = 0; k < 3; ++k) {
      mean_of_rows(row_of(sums, k * step), pitch, 2 * step - 1, -step, width + step, row_of(boxes, k));
    }
    row_slopes(heights.row(middle) + room, {row_of(boxes, 1), row_of(boxes, 0), row_of(boxes, 2)}, settings, width,
               slopes.row(0), slopes.row(1));
    int sloped = 0;
    for (int u = 0; u < width; ++u) {
      const float height = heights(room + u, middle);
      const Slope across = limited_slope(height, box(u - step, middle), box(u + step, middle), settings);
      const Slope down = limited_slope(height, box(u, middle - step), box(u, middle + step), settings);
      const float share = slope_share(across, down);
      ASSERT_NEAR(slopes(u, 0), share * across.value, 1e-4) << step << ", " << u;
      ASSERT_NEAR(slopes(u, 1), share * down.value, 1e-4) << step << ", " << u;
      sloped += slopes(u, 0) != 0 || slopes(u, 1) != 0;
    }
    EXPECT_GT(sloped, width / 5);
  }
}

/// A road and the floor of a pothole 4 px below it, each known to 0.05 px, and between them a wall 50 pixels wide known
/// to 0.3 px. What is known better than the wall would draw it to either side; what is expected of it along the slope
/// does not.
TEST(Slopes, WallBetweenRoadAndFloorKeepsItsShape) {
  constexpr int width = 120, height = 60, foot = 85, rim = 35;
  Image<float> disparity(width, height), variance(width, height);
  const auto truth = [](int u) { return 20 - 4 * std::clamp((u - rim) / static_cast<double>(foot - rim), 0.0, 1.0); };
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const bool wall = u > rim && u < foot;
      disparity(u, v) = static_cast<float>(truth(u) + (wall ? 0.6 : 0.1) * (test::lattice(u, v, 4) - 0.5));
      variance(u, v) = wall ? 0.09F : 0.0025F;
    }
  }
  Image<float> refined, sigma;
  refine_disparities(disparity, variance, 1, {0, 0, 0}, 100, {}, 1, refined, sigma);
  double squares = 0;
  for (int u = rim + 1; u < foot; ++u) squares += std::pow(refined(u, height / 2) - truth(u), 2);
  EXPECT_LT(std::sqrt(squares / (foot - rim - 1)), 0.2);  // 0.38 on the level
}

}  // namespace
}  // namespace roadstereo
