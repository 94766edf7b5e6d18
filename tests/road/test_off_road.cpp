// Rejection of disparities beside the road: maps whose cells are confirmed or not by the closed form of the limit.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/off_road.hpp"
#include "tests/road/cell_maps.hpp"

namespace roadstereo {
namespace {

std::size_t count_invalid(const Image<float>& map) {
  std::size_t count = 0;
  for (int v = 0; v < map.height(); ++v) {
    for (int u = 0; u < map.width(); ++u) count += std::isnan(map(u, v)) ? 1U : 0U;
  }
  return count;
}

/// Disparity and σ of a map of one σ, after the rejection.
test::CellMaps reject_uniform(float sigma, float correlation, double max_sigma_px) {
  test::CellMaps maps(80, 60);
  maps.fill(sigma, correlation);
  reject_off_road(maps.correlation, {max_sigma_px}, 1, maps.disparity, maps.sigma);
  return maps;
}

TEST(RejectOffRoad, LimitFollowsCorrelation) {
  for (const float correlation : {-0.5F, 0.0F, 0.4F, 0.8F, 1.0F}) {
    for (const double max_sigma_px : {0.5, 1.0}) {
      const double limit = max_sigma_px * std::pow(3, correlation - 1);
      // The logarithm of a float by its bits is up to 0.09 too small: 6 %.
      EXPECT_EQ(count_invalid(reject_uniform(static_cast<float>(0.98 * limit), correlation, max_sigma_px).disparity),
                0U)
          << correlation;
      const test::CellMaps rejected = reject_uniform(static_cast<float>(1.08 * limit), correlation, max_sigma_px);
      EXPECT_EQ(count_invalid(rejected.disparity), rejected.disparity.pixels()) << correlation;
      EXPECT_EQ(count_invalid(rejected.sigma), rejected.sigma.pixels()) << correlation;
    }
  }
}

TEST(RejectOffRoad, KeepsWhatRoadEncloses) {
  test::CellMaps maps(400, 200);
  maps.fill(0.1F, 0.9F);
  maps.paint({40, 15, 60, 30}, 2.0F, 0.1F);  // cells: 160 × 60 pixels inside
  maps.paint({0, 20, 14, 35}, 2.0F, 0.1F);   // at the left border
  reject_off_road(maps.correlation, {1.0}, 1, maps.disparity, maps.sigma);
  EXPECT_FALSE(std::isnan(maps.disparity(200, 90)));
  EXPECT_TRUE(std::isnan(maps.disparity(2, 110)));
  EXPECT_TRUE(std::isnan(maps.sigma(2, 110)));
  EXPECT_FALSE(std::isnan(maps.disparity(120, 110)));
  EXPECT_FALSE(std::isnan(maps.disparity(2, 20)));
}

TEST(RejectOffRoad, LowerBorderIsRoad) {
  test::CellMaps maps(200, 120);
  maps.fill(0.1F, 0.9F);
  maps.paint({20, 20, 40, 30}, 2.0F, 0.1F);
  reject_off_road(maps.correlation, {1.0}, 1, maps.disparity, maps.sigma);
  EXPECT_EQ(count_invalid(maps.disparity), 0U);
}

/// Half of the cells around the edge of a step are unconfirmed: at the edge the geometric mean is that of both sides.
TEST(RejectOffRoad, OutermostCellsStay) {
  constexpr float low = 0.125F, high = 2.0F;  // powers of two: their logarithms are exact
  test::CellMaps maps(400, 80);
  maps.fill(low, 0.5F);
  maps.paint({0, 0, 50, 20}, high, 0.5F);  // columns of cells 0 to 49
  // log2 of the limit: log2(3)·(0.5 − 1) = −0.79. Of nine columns k are low: 1 − 4 k/9 > −0.79 up to k = 4, so that
  // column 49 (whose window has 45 … 53) is unconfirmed, 50 (five low ones) is not, and 49 is an outermost cell.
  reject_off_road(maps.correlation, {1.0}, 1, maps.disparity, maps.sigma);
  EXPECT_TRUE(std::isnan(maps.disparity(4 * 48 + 3, 40)));
  EXPECT_FALSE(std::isnan(maps.disparity(4 * 49, 40)));
}

TEST(RejectOffRoad, PixelsWithoutDisparityCountAsThreePixels) {
  for (const float correlation : {0.0F, 1.0F}) {
    test::CellMaps maps(80, 60);
    maps.fill(0.05F, correlation);
    for (int v = 0; v < 60; ++v) {
      for (int u = 0; u < 80; u += 2) maps.disparity(u, v) = maps.sigma(u, v) = std::numeric_limits<float>::quiet_NaN();
    }
    // √(0.05·3) = 0.39 pixels: above a third, below one.
    reject_off_road(maps.correlation, {1.0}, 1, maps.disparity, maps.sigma);
    EXPECT_EQ(count_invalid(maps.disparity), correlation == 0 ? 4800U : 2400U);
  }
}

TEST(RejectOffRoad, SameForAnyThreadCount) {
  test::CellMaps one = test::maze(317, 203);
  test::CellMaps three = one;
  reject_off_road(one.correlation, {1.0}, 1, one.disparity, one.sigma);
  reject_off_road(three.correlation, {1.0}, 3, three.disparity, three.sigma);
  EXPECT_GT(count_invalid(one.disparity), 0U);
  for (int v = 0; v < one.disparity.height(); ++v) {
    for (int u = 0; u < one.disparity.width(); ++u) {
      ASSERT_EQ(std::isnan(one.disparity(u, v)), std::isnan(three.disparity(u, v))) << u << ", " << v;
    }
  }
}

TEST(RejectOffRoad, RefusesMapsOfOtherSizes) {
  test::CellMaps maps(80, 60);
  maps.fill(0.1F, 0.9F);
  Image<float> narrow(79, 60, 0.1F);
  EXPECT_THROW(reject_off_road(maps.correlation, {1.0}, 1, maps.disparity, narrow), Error);
  const Image<float> few(19, 15, 0.9F);
  EXPECT_THROW(reject_off_road(few, {1.0}, 1, maps.disparity, maps.sigma), Error);
  EXPECT_THROW(reject_off_road(maps.correlation, {-1}, 1, maps.disparity, maps.sigma), Error);
}

}  // namespace
}  // namespace roadstereo
