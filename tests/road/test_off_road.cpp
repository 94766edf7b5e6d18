// Rejection of disparities beside the road: maps whose cells are on the road, contradicted or unconfirmed by
// construction and by the closed form of the limit of σ.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "roadstereo/error.hpp"
#include "roadstereo/off_road.hpp"
#include "tests/road/street_maps.hpp"

namespace roadstereo {
namespace {

using Cells = test::StreetMaps::Cells;

test::StreetMaps reject(test::StreetMaps maps, double max_sigma_px = 1, int threads = 1) {
  reject_off_road(maps.correlation, maps.scene.view(), maps.shift, {}, {max_sigma_px}, threads, maps.disparity,
                  maps.sigma);
  return maps;
}

/// Whether every pixel of the cells is invalid, or none.
testing::AssertionResult all_are(const test::StreetMaps& maps, const Cells& cells, bool invalid) {
  testing::AssertionResult result = testing::AssertionSuccess();
  maps.for_pixels(cells, [&](int u, int v) {
    if (std::isnan(maps.disparity(u, v)) == invalid && std::isnan(maps.sigma(u, v)) == invalid) return;
    result = testing::AssertionFailure() << "at " << u << ", " << v;
  });
  return result;
}

/// The logarithm of a float by its bits is up to 0.09 too small: 6 %.
TEST(RejectOffRoad, LimitOfSigmaFollowsCorrelation) {
  for (const float correlation : {-0.5F, 0.0F, 0.4F, 0.8F, 1.0F}) {
    for (const double max_sigma_px : {0.5, 1.0}) {
      const double limit = max_sigma_px * std::pow(3, correlation - 1);
      for (const double of_limit : {0.98, 1.08}) {
        test::StreetMaps street(80, 64, 4);
        street.forget_scene();
        street.paint_sigma(street.all(), static_cast<float>(of_limit * limit), correlation);
        EXPECT_TRUE(all_are(reject(street, max_sigma_px), street.all(), of_limit > 1)) << correlation;
      }
    }
  }
}

/// Pixels that a mask hides have no disparity, and say nothing of their surroundings.
TEST(RejectOffRoad, MaskedPixelsDoNotCount) {
  test::StreetMaps street(80, 64, 4);
  street.forget_scene();
  street.paint_sigma(street.all(), 0.3F, 0.5F);  // the limit is 0.58 px
  Image<std::uint8_t> mask(80, 64, 0);
  for (int v = 32; v < 64; ++v) {
    std::fill_n(mask.row(v), 80, std::uint8_t{255});
    std::fill_n(street.disparity.row(v), 80, NAN);
    std::fill_n(street.sigma.row(v), 80, NAN);
  }
  const Cells seen{0, 0, 20, 8};
  EXPECT_FALSE(all_are(reject(street), seen, false)) << "without a mask they do";
  reject_off_road(street.correlation, street.scene.view(), street.shift, mask, {1}, 1, street.disparity, street.sigma);
  EXPECT_TRUE(all_are(street, seen, false));
  EXPECT_THROW(reject_off_road(street.correlation, street.scene.view(), street.shift, Image<std::uint8_t>(80, 63, 0),
                               {1}, 1, street.disparity, street.sigma),
               Error);
}

/// A bonnet that reaches both sides is no way around the road: what it touches stays, as at a bare lower border. What
/// lies below a masked sky or beside a black border is outside as if they were not there.
TEST(RejectOffRoad, MaskIsNoWayAroundRoad) {
  test::StreetMaps street(400, 240, 4);
  street.paint_scene({30, 48, 50, 54}, 30);  // touches the bonnet
  street.paint_scene({60, 2, 70, 40}, 30);   // touches the sky
  street.paint_scene({0, 30, 20, 40}, 30);   // touches the black border
  Image<std::uint8_t> mask(400, 240, 0);
  const auto paint_mask = [&](const Cells& cells) {
    street.paint_holes(cells);
    street.for_pixels(cells, [&](int u, int v) { mask(u, v) = 255; });
  };
  paint_mask({0, 54, 100, 60});
  paint_mask({0, 0, 100, 2});
  paint_mask({0, 0, 1, 60});
  reject_off_road(street.correlation, street.scene.view(), street.shift, mask, {1}, 1, street.disparity, street.sigma);
  EXPECT_TRUE(all_are(street, {22, 41, 100, 54}, false));
  EXPECT_TRUE(all_are(street, {64, 26, 66, 38}, true));
  EXPECT_TRUE(all_are(street, {1, 32, 16, 38}, true));
}

/// At the edge of a step the geometric mean is that of both sides.
TEST(RejectOffRoad, SigmaIsThatOfTheSurroundings) {
  constexpr float low = 0.125F, high = 2.0F;  // powers of two: their logarithms are exact
  test::StreetMaps street(400, 80, 4);
  street.forget_scene();
  street.paint_sigma(street.all(), low, 0.5F);
  street.paint_sigma({0, 0, 50, 20}, high, 0.5F);
  // log2 of the limit: log2(3)·(0.5 − 1) = −0.79. Of nine columns k are low: 1 − 4 k/9 > −0.79 up to k = 4, so that
  // column 49 (whose window has 45 … 53) is unconfirmed, and 50 (five low ones) is not.
  const test::StreetMaps maps = reject(street);
  EXPECT_TRUE(all_are(maps, {0, 0, 50, 20}, true));
  EXPECT_TRUE(all_are(maps, {50, 0, 100, 20}, false));
}

TEST(RejectOffRoad, PixelsWithoutDisparityCountAsThreePixels) {
  for (const float correlation : {0.0F, 1.0F}) {
    test::StreetMaps street(80, 64, 4);
    street.forget_scene();
    street.paint_sigma(street.all(), 0.05F, correlation);
    for (int v = 0; v < 64; ++v) {
      for (int u = 0; u < 80; u += 2) street.disparity(u, v) = street.sigma(u, v) = test::StreetMaps::nan;
    }
    // √(0.05·3) = 0.39 pixels: above a third, below one.
    EXPECT_EQ(std::isnan(reject(street).disparity(1, 1)), correlation == 0);
  }
}

/// Noise: what is the road for both searches stays, and what both see above the horizon (cells 24).
TEST(RejectOffRoad, AgreementNeedsNoSmallSigma) {
  test::StreetMaps street(400, 240, 4);
  street.paint_sigma(street.all(), 2, 0);
  EXPECT_TRUE(all_are(reject(street), {0, 0, 100, 24}, false));
  EXPECT_TRUE(all_are(reject(street), {0, 25, 100, 60}, false));
  street.forget_scene();
  EXPECT_TRUE(all_are(reject(street), street.all(), true));
}

/// A vehicle that was matched as the road behind it, from above the horizon (cells 24) to the road.
TEST(RejectOffRoad, RejectsWhatSceneContradicts) {
  for (const int factor : {4, 8}) {
    test::StreetMaps street(400, 240, factor);
    street.paint_scene({40, 20, 60, 40}, 30);
    const test::StreetMaps maps = reject(street);
    // Within four coarse columns and a row of its edges the road is as good a match of the scene.
    const int columns = factor, row = factor / 4;
    EXPECT_TRUE(all_are(maps, {40 + columns, 25, 60 - columns, 40 - row}, true)) << factor;
    EXPECT_TRUE(all_are(maps, {0, 41, 100, 60}, false)) << factor;
    EXPECT_TRUE(all_are(maps, {0, 25, 39, 60}, false)) << factor;
    EXPECT_TRUE(all_are(maps, {61, 25, 100, 60}, false)) << factor;
  }
}

/// Of an unconfirmed cell only the next coarse column counts.
TEST(RejectOffRoad, UnconfirmedRoadIsComparedNearby) {
  test::StreetMaps street(400, 240, 4);
  street.paint_scene({40, 20, 60, 40}, 30);
  street.paint_sigma(street.all(), 2, 0);
  const test::StreetMaps maps = reject(street);
  EXPECT_TRUE(all_are(maps, {41, 26, 59, 40}, true));
  EXPECT_TRUE(all_are(maps, {0, 41, 100, 60}, false));
}

/// Above the horizon nothing is road: the coarse pixel of the cell alone counts, and the cells beside a contradicted
/// one go with it.
TEST(RejectOffRoad, NeighboursOfContradictedCellsGo) {
  test::StreetMaps street(400, 240, 4);
  street.paint_scene({40, 8, 60, 16}, 30);
  const test::StreetMaps maps = reject(street);
  EXPECT_TRUE(all_are(maps, {39, 7, 61, 17}, true));
  EXPECT_TRUE(all_are(maps, {0, 0, 39, 24}, false));
  EXPECT_TRUE(all_are(maps, {0, 17, 100, 24}, false));
}

TEST(RejectOffRoad, KeepsWhatRoadEncloses) {
  test::StreetMaps street(400, 240, 4);
  street.paint_scene({40, 35, 60, 45}, 30);
  street.paint_scene({30, 50, 50, 60}, 30);  // at the lower border
  EXPECT_TRUE(all_are(reject(street), street.all(), false));
  const test::Maze maze(413, 331);
  const test::StreetMaps maps = reject(maze.maps);
  EXPECT_TRUE(all_are(maps, maze.reached, true));
  EXPECT_TRUE(all_are(maps, maze.enclosed, false));
}

/// Half a coarse pixel: of 4 pixels, 2. Above the horizon, and where the residual disparity of the road is the same in
/// all rows: elsewhere that of the row above or below may agree.
TEST(RejectOffRoad, ToleratesHalfACoarsePixel) {
  for (const float offset : {-1.9F, 1.9F, -2.1F, 2.1F}) {
    test::StreetMaps street(400, 240, 4);
    street.paint_scene(street.all(), offset);
    const test::StreetMaps maps = reject(street);
    EXPECT_TRUE(all_are(maps, {0, 0, 100, 24}, std::abs(offset) > 2)) << offset;
    EXPECT_TRUE(all_are(maps, {0, 34, 100, 60}, std::abs(offset) > 2)) << offset;
  }
}

TEST(RejectOffRoad, ZeroKeepsEverything) {
  test::StreetMaps street(400, 240, 4);
  street.paint_scene(street.all(), 30);
  street.paint_sigma(street.all(), 3, 0);
  EXPECT_TRUE(all_are(reject(street, 0), street.all(), false));
}

TEST(RejectOffRoad, SameForAnyThreadCount) {
  const test::Maze maze(413, 331);
  const test::StreetMaps one = reject(maze.maps, 1, 1), three = reject(maze.maps, 1, 3);
  one.for_pixels(one.all(), [&](int u, int v) {
    ASSERT_EQ(std::isnan(one.disparity(u, v)), std::isnan(three.disparity(u, v))) << u << ", " << v;
  });
}

TEST(RejectOffRoad, RefusesMapsOfOtherSizes) {
  const auto message = [](const test::StreetMaps& maps) {
    try {
      reject(maps);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  test::StreetMaps street(400, 240, 4);
  street.sigma.resize(399, 240);
  EXPECT_NE(message(street).find("399×240"), std::string::npos) << message(street);
  street = test::StreetMaps(400, 240, 4);
  street.correlation.resize(99, 60);
  EXPECT_NE(message(street).find("99×60 cells"), std::string::npos) << message(street);
  street = test::StreetMaps(400, 240, 4);
  street.scene.factor = 8;
  EXPECT_NE(message(street).find("100×60 pixels of 8×8"), std::string::npos) << message(street);
  EXPECT_THROW(reject(test::StreetMaps(400, 240, 4), -1), Error);
}

}  // namespace
}  // namespace roadstereo
