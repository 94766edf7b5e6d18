// The search ranges of the tiles: they must hold the true disparities, and be narrow where the road is all there is.

#include <gtest/gtest.h>

#include <cmath>

#include "roadstereo/perspective.hpp"
#include "roadstereo/synth.hpp"
#include "stereo/range_search.hpp"
#include "textured_pair.hpp"

namespace roadstereo {
namespace {

TEST(RangeSearch, HoldsTheTrueDisparitiesOfRoads) {
  for (const char* name : {"uav", "street", "close", "low_texture", "noise"}) {
    SCOPED_TRACE(name);
    synth::Scene scene = synth::named_scene(name);
    scene.supersampling = 1;
    const synth::SyntheticPair pair = synth::render(scene);
    PerspectiveShift shift;
    shift.road = pair.plane;
    shift.disparities = 48;
    shift.delta_p = 24;
    GreyImage left, right, target;
    std::vector<int> first_column;
    to_grey(pair.left.view(), 0, left);
    to_grey(pair.right.view(), 0, right);
    transform_target(right, shift, 0, target, first_column);
    RangeSearch search("cpu", 2);
    const SearchRanges* ranges = search.find({left, target, first_column.data(), shift.disparities});
    ASSERT_NE(ranges, nullptr);
    std::size_t seen = 0, held = 0;
    double searched = 0;
    for (int v = 0; v < left.height(); ++v) {
      for (int u = 0; u < left.width(); ++u) {
        const SearchRanges::Range& range =
            ranges->reference(u / SearchRanges::tile_columns, v / SearchRanges::tile_rows);
        searched += range.end - range.first;
        if (!pair.visible(u, v)) continue;
        const double full = pair.disparity(u, v);
        const double residual = full - shift.at(u - full, v);
        if (std::isnan(full) || residual < 0 || residual > shift.disparities - 1) continue;
        ++seen;
        held += residual >= range.first && residual <= range.end - 1;
      }
    }
    EXPECT_GE(static_cast<double>(held), 0.995 * static_cast<double>(seen));
    EXPECT_LE(searched / static_cast<double>(left.pixels()), 0.75 * shift.disparities);
  }
}

TEST(RangeSearch, SearchesNearlyEverythingWhereNothingMatches) {
  const auto one = test::textured_pair(
      256, 192, [](double, double) { return 0; }, 1);
  const auto other = test::textured_pair(
      256, 192, [](double, double) { return 0; }, 99);
  RangeSearch search("cpu", 1);
  const SearchRanges* ranges = search.find({one.reference, other.target, nullptr, 40});
  ASSERT_NE(ranges, nullptr);
  EXPECT_GE(ranges->reference(0, 0).end - ranges->reference(0, 0).first, 32);
  EXPECT_GE(ranges->target(0, 0).end - ranges->target(0, 0).first, 32);
}

TEST(RangeSearch, FindsAThingThatStandsOut) {
  // Road at 20, a block 48 pixels wide at 34, within one tile.
  const auto pair =
      test::textured_pair(256, 192, [](double u, double v) { return u > 80 && u < 128 && v > 30 && v < 70 ? 34 : 20; });
  RangeSearch search("cpu", 1);
  const SearchRanges* ranges = search.find({pair.reference, pair.target, nullptr, 48});
  ASSERT_NE(ranges, nullptr);
  EXPECT_LE(ranges->reference(0, 0).first, 19);
  EXPECT_GE(ranges->reference(0, 0).end, 36);
  EXPECT_LE(ranges->reference(0, 1).first, 19);
  EXPECT_LE(ranges->reference(0, 1).end, 30);
}

TEST(RangeSearch, IsNotWorthItForFewDisparitiesOrSmallImages) {
  const GreyImage image(256, 192, 1600), small(100, 90, 1600);
  RangeSearch search("cpu", 1);
  EXPECT_EQ(search.find({image, image, nullptr, 8}), nullptr);
  EXPECT_EQ(search.find({small, small, nullptr, 64}), nullptr);
}

}  // namespace
}  // namespace roadstereo
