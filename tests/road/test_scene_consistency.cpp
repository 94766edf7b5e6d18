// Check of disparities beside the road with a coarse map of the whole scene: boxes whose cells are known.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/off_road.hpp"
#include "tests/road/coarse_scene.hpp"

namespace roadstereo {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Whether every pixel of the cells is invalid, or none.
testing::AssertionResult all_are(const test::StreetMaps& maps, const test::StreetMaps::Cells& cells, bool invalid) {
  for (int v = 4 * cells.top; v < 4 * cells.bottom; ++v) {
    for (int u = 4 * cells.left; u < 4 * cells.right; ++u) {
      if (std::isnan(maps.disparity(u, v)) != invalid || std::isnan(maps.sigma(u, v)) != invalid) {
        return testing::AssertionFailure() << "at " << u << ", " << v;
      }
    }
  }
  return testing::AssertionSuccess();
}

test::StreetMaps check(test::StreetMaps maps, int threads = 1) {
  reject_inconsistent(maps.coarse.view(), maps.shift, threads, maps.disparity, maps.sigma);
  return maps;
}

TEST(RejectInconsistent, KeepsWhatAgrees) {
  const test::StreetMaps maps = check(test::StreetMaps(400, 240, 4));
  EXPECT_TRUE(all_are(maps, {0, 0, 100, 60}, false));
}

/// A vehicle that was matched as the road behind it, from the horizon (row 96, cells 24) to the road.
TEST(RejectInconsistent, RejectsVehicleThatReachesHorizon) {
  for (const int factor : {4, 8}) {
    test::StreetMaps street(400, 240, factor);
    const test::StreetMaps::Cells vehicle{40, 20, 60, 40};
    street.paint_coarse(vehicle, 30);
    const test::StreetMaps maps = check(street);
    // Beside its edges the road within four coarse pixels is as good a match of the coarse map.
    const int at_edge = 4 * factor / 4, below = factor / 4;
    EXPECT_TRUE(all_are(maps, {40 + at_edge, 25, 60 - at_edge, 40 - below}, true)) << factor;
    EXPECT_TRUE(all_are(maps, {0, 41, 100, 60}, false)) << factor;
    EXPECT_TRUE(all_are(maps, {0, 25, 39, 60}, false)) << factor;
    EXPECT_TRUE(all_are(maps, {61, 25, 100, 60}, false)) << factor;
  }
}

/// Above the horizon nothing is road: the coarse pixel of the cell alone counts, and the cells beside a contradicted
/// one go with it.
TEST(RejectInconsistent, NeighboursOfContradictedCellsGo) {
  test::StreetMaps street(400, 240, 4);
  street.paint_coarse({40, 8, 60, 16}, 30);
  const test::StreetMaps maps = check(street);
  EXPECT_TRUE(all_are(maps, {39, 7, 61, 17}, true));
  EXPECT_TRUE(all_are(maps, {0, 0, 39, 24}, false));
  EXPECT_TRUE(all_are(maps, {0, 17, 100, 24}, false));
}

TEST(RejectInconsistent, KeepsWhatRoadEncloses) {
  test::StreetMaps street(400, 240, 4);
  street.paint_coarse({40, 35, 60, 45}, 30);
  street.paint_coarse({30, 50, 50, 60}, 30);  // at the lower border
  EXPECT_TRUE(all_are(check(street), {0, 0, 100, 60}, false));
}

/// Half a coarse pixel: of 4 pixels, 2. Above the horizon, and where the residual disparity of the road is the same in
/// all rows: elsewhere that of the row above or below may agree.
TEST(RejectInconsistent, ToleratesHalfACoarsePixel) {
  for (const float offset : {-1.9F, 1.9F, -2.1F, 2.1F}) {
    test::StreetMaps street(400, 240, 4);
    street.paint_coarse({0, 0, 100, 60}, offset);
    const test::StreetMaps maps = check(street);
    EXPECT_TRUE(all_are(maps, {0, 0, 100, 24}, std::abs(offset) > 2)) << offset;
    EXPECT_TRUE(all_are(maps, {0, 34, 100, 60}, std::abs(offset) > 2)) << offset;
  }
}

TEST(RejectInconsistent, UnknownContradictsNothing) {
  test::StreetMaps street(400, 240, 4);
  street.paint_coarse({0, 0, 100, 60}, nan);
  EXPECT_TRUE(all_are(check(street), {0, 0, 100, 60}, false));
}

TEST(RejectInconsistent, SameForAnyThreadCount) {
  test::StreetMaps street(317, 203, 4);
  street.paint_coarse({30, 10, 60, 40}, 30);
  const test::StreetMaps one = check(street, 1), three = check(street, 3);
  int rejected = 0;
  for (int v = 0; v < one.disparity.height(); ++v) {
    for (int u = 0; u < one.disparity.width(); ++u) {
      ASSERT_EQ(std::isnan(one.disparity(u, v)), std::isnan(three.disparity(u, v))) << u << ", " << v;
      rejected += std::isnan(one.disparity(u, v)) ? 1 : 0;
    }
  }
  EXPECT_GT(rejected, 0);
}

TEST(RejectInconsistent, RefusesMapsOfOtherSizes) {
  test::StreetMaps street(400, 240, 4);
  Image<float> narrow(399, 240, 0.1F);
  EXPECT_THROW(reject_inconsistent(street.coarse.view(), street.shift, 1, street.disparity, narrow), Error);
  street.coarse.factor = 8;
  try {
    reject_inconsistent(street.coarse.view(), street.shift, 1, street.disparity, street.sigma);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("100×60 pixels of 8"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace roadstereo
