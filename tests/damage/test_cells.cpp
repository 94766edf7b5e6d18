// Means of a map over cells, and gaps between known cells interpolated.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "damage/cells.hpp"
#include "damage/depth_cells.hpp"

namespace roadstereo {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

TEST(InterpolateGaps, RestoresLinearField) {
  const double across = 0.03, down = -0.05;
  const auto field = [&](int i, int j) { return static_cast<float>(7 + across * i + down * j); };
  for (const int radius : {2, 5, 10}) {
    Image<float> values(97, 71);
    Image<std::uint8_t> known(97, 71, 255);
    for (int j = 0; j < 71; ++j) {
      for (int i = 0; i < 97; ++i) {
        values(i, j) = field(i, j);
        for (const auto& [u, v] : {std::array{25, 30}, std::array{62, 41}}) {
          if ((i - u) * (i - u) + (j - v) * (j - v) <= radius * radius) known(i, j) = 0;
        }
        if (known(i, j) == 0) values(i, j) = none;
      }
    }
    fill_gaps(values, known, 1);
    const double rise = 2 * radius * std::hypot(across, down);  // of the field over the gap
    double worst = 0;
    for (int j = 0; j < 71; ++j) {
      for (int i = 0; i < 97; ++i) {
        if (known(i, j) != 0) {
          ASSERT_EQ(values(i, j), field(i, j));
        }
        const auto error = static_cast<double>(std::abs(values(i, j) - field(i, j)));
        if (std::isnan(error) || error > worst) worst = error;
      }
    }
    EXPECT_LT(worst, 0.35 * rise) << "radius " << radius;  // a constant would be wrong by half of it
  }
}

TEST(InterpolateGaps, OneKnownCellFillsMap) {
  Image<float> values(33, 20, none);
  Image<std::uint8_t> known(33, 20, 0);
  values(31, 2) = 4.5F;
  known(31, 2) = 255;
  fill_gaps(values, known, 1);
  for (int j = 0; j < 20; ++j) {
    for (int i = 0; i < 33; ++i) ASSERT_NEAR(values(i, j), 4.5, 1e-5);
  }
}

TEST(Cells, AverageValidPixels) {
  Image<float> map(7, 5, none);
  map(0, 0) = 2;
  map(1, 0) = 4;
  map(2, 0) = 9;  // alone in its cell
  map(3, 3) = 1;
  map(2, 2) = std::numeric_limits<float>::infinity();
  map(2, 3) = 3;
  map(6, 0) = 5;  // half of a cell that the border cuts
  const Cells cells = make_cells(map, {}, 0, 2, 1);
  ASSERT_EQ(cells.width(), 4);
  ASSERT_EQ(cells.height(), 3);
  EXPECT_EQ(cells.value(0, 0), 3);
  EXPECT_TRUE(std::isnan(cells.value(1, 0)));
  EXPECT_EQ(cells.value(1, 1), 2);
  EXPECT_EQ(cells.value(3, 0), 5);
}

// A hollow of 4 rows and a step, both 3 px deep. Half the second difference over 6 px is 3 in the hollow, and 1.5 at
// the step, whose place is not known: there the pixels stay out.
TEST(Cells, HollowNarrowerThanSmoothingIsCertain) {
  constexpr int smoothing_px = 6;
  Image<float> map(40, 60, 20.0F), sigma(40, 60, 0.1F);
  for (int v = 0; v < map.height(); ++v) {
    const bool in_hollow = v >= 20 && v < 24, below_step = v >= 40;
    for (int u = 0; u < map.width(); ++u) {
      if (in_hollow || below_step) map(u, v) = 17;
      if (in_hollow) sigma(u, v) = std::hypot(0.1F, 3.0F);
      if (v >= 40 && v < 46) sigma(u, v) = std::hypot(0.1F, 1.5F);
    }
  }
  const Cells cells = make_cells(map, sigma, smoothing_px, 2, 1);
  for (int j : {10, 11}) EXPECT_EQ(cells.value(10, j), 17);
  for (int j : {20, 21, 22}) EXPECT_TRUE(std::isnan(cells.value(10, j))) << j;
  EXPECT_EQ(cells.value(10, 24), 17);
  for (int v = 20; v < 24; ++v) std::fill_n(sigma.row(v), 40, std::hypot(1.1F, 3.0F));  // noise alone is too much
  for (int j : {10, 11}) EXPECT_TRUE(std::isnan(make_cells(map, sigma, smoothing_px, 2, 1).value(10, j))) << j;
}

// 12 = 5 + 5 + 2: the last cells have 10 and 4 pixels, fewer than half of 25.
TEST(Cells, CutByBorderAverageWhatTheyHave) {
  Image<float> map(12, 12, 3.0F);
  map(0, 0) = 28;
  const Cells cells = make_cells(map, {}, 0, 5, 1);
  ASSERT_EQ(cells.width(), 3);
  EXPECT_EQ(cells.value(0, 0), 4);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(cells.value(2, k), 3);
    EXPECT_EQ(cells.value(k, 2), 3);
  }
}

}  // namespace
}  // namespace roadstereo
