// Basins of a component of deep cells, against saddles in closed form.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "damage/cores.hpp"

namespace roadstereo {
namespace {

constexpr int core_columns = 120, core_rows = 60;

/// Cones 12 deep at column 40 and `second` deep at column 80, that end at `saddle` between them.
Image<float> two_cones(float second, float saddle) {
  Image<float> depth(core_columns, core_rows);
  for (int j = 0; j < core_rows; ++j) {
    for (int i = 0; i < core_columns; ++i) {
      const auto cone = [&](int column, float floor) {
        return floor - 0.5F * static_cast<float>(std::hypot(i - column, j - 30));
      };
      const bool between = i >= 40 && i <= 80 && std::abs(j - 30) < 6;
      depth(i, j) = std::max({cone(40, 12), cone(80, second), between ? saddle : 0.0F});
    }
  }
  return depth;
}

struct CoreSearch {
  Image<float> transformed{core_columns, core_rows, 0.0F};
  DamageInput input;
  DamageOptions options;
  Cells cells;
  SurfaceCoordinates coordinates;

  /// Cells of one pixel, without a calibration; depths of more than 1, at least 20 cells.
  Cores cores(const Image<float>& depth) {
    input.transformed = transformed;
    options.min_area_share = 20.0 / (core_columns * core_rows);
    cells.value.assign(core_columns, core_rows, 0.0F);
    coordinates.scale.assign(core_columns, core_rows, 0.0F);
    const Thresholds thresholds(input, options, cells, coordinates, 1 / options.threshold_sigma, false);
    Image<std::uint8_t> deep(core_columns, core_rows);
    for (int j = 0; j < core_rows; ++j) {
      for (int i = 0; i < core_columns; ++i) deep(i, j) = depth(i, j) > 1 ? 255 : 0;
    }
    return {depth, deep, thresholds};
  }
};

TEST(Cores, AreTheBasinsOverASaddle) {
  CoreSearch search;
  for (const float saddle : {1.2F, 1.5F, 2.0F}) {
    Cores found = search.cores(two_cones(10, saddle));
    ASSERT_EQ(found.cores().size(), 3U) << saddle;
    EXPECT_TRUE(found.cores()[2].is_divided);
    EXPECT_EQ(found.cores()[2].saddle, 0);
    EXPECT_GT(found.cores()[2].cells.size, found.cores()[0].cells.size + found.cores()[1].cells.size);
    EXPECT_EQ(found.cores()[0].cells.box.first_row + found.cores()[0].cells.box.last_row, 60);
    EXPECT_LT(found.cores()[0].cells.box.last_column, 62) << "the larger one is first";
    EXPECT_GT(found.cores()[1].cells.box.first_column, 62);
    for (const std::size_t k : {0U, 1U}) {
      EXPECT_FALSE(found.cores()[k].is_divided);
      EXPECT_GE(found.cores()[k].saddle, saddle);
      EXPECT_LE(found.cores()[k].saddle, 5) << "half of the floor";
    }
  }
}

TEST(Cores, HighSaddleDividesNothing) {
  CoreSearch search;
  for (const float second : {10.0F, 4.0F}) {
    Cores found = search.cores(two_cones(second, 5.5F));
    ASSERT_EQ(found.cores().size(), 1U) << second;
    EXPECT_EQ(found.cores()[0].saddle, 0);
  }
}

TEST(Cores, SmallPitIsNoBasin) {
  CoreSearch search;
  Image<float> depth = two_cones(0, 2);
  for (int j = 28; j < 32; ++j) std::fill_n(depth.row(j) + 76, 4, 11.0F);  // 16 cells
  EXPECT_EQ(search.cores(depth).cores().size(), 1U);
}

}  // namespace
}  // namespace roadstereo
