// The coarse look at a pair: the ranges of the tiles must hold the true disparities and be narrow where the road is all
// there is; the prior must lie near the truth, and on the road where the picture shows nothing.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <string>
#include <vector>

#include "core/downsample.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/perspective.hpp"
#include "roadstereo/synth.hpp"
#include "stereo/coarse/coarse_map.hpp"
#include "stereo/coarse/coarse_search.hpp"
#include "stereo/coarse/coarse_size.hpp"
#include "stereo/cpu/padded_rows.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

PerspectiveShift shift_of(const DisparityPlane& road, double delta_p) {
  PerspectiveShift shift;
  shift.road = road;
  shift.delta_p = delta_p;
  return shift;
}

PerspectiveShift no_shift() {
  PerspectiveShift shift;
  shift.enabled = false;
  return shift;
}

const PerspectiveShift no_road = no_shift();

class SlowCoarseSearchScene : public testing::TestWithParam<const char*> {};

TEST_P(SlowCoarseSearchScene, RangesHoldTrueDisparities) {
  synth::Scene scene = synth::named_scene(GetParam());
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
  CoarseSearch search({}, 2);
  ASSERT_TRUE(search.find({left, target, first_column.data(), shift.disparities}, shift));
  const SearchRanges* ranges = search.ranges();
  ASSERT_NE(ranges, nullptr);
  std::size_t seen = 0, held = 0;
  double searched = 0;
  for (int v = 0; v < left.height(); ++v) {
    for (int u = 0; u < left.width(); ++u) {
      const SearchRange& range = ranges->reference(u / SearchRanges::tile_columns, v / SearchRanges::tile_rows);
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

INSTANTIATE_TEST_SUITE_P(Scenes, SlowCoarseSearchScene,
                         testing::Values("uav", "street", "close", "low_texture", "noise"),
                         [](const auto& test) { return std::string(test.param); });

TEST(CoarseFactor, LeavesEnoughColumnsAndDisparities) {
  CoarseSearchOptions options;
  for (const auto& [width, disparities, factor] : std::vector<std::array<int, 3>>{{640, 13, 2},
                                                                                  {1600, 64, 2},
                                                                                  {2079, 64, 4},
                                                                                  {8192, 256, 8},
                                                                                  // Seen from above a road is few
                                                                                  // disparities thick.
                                                                                  {1920, 12, 2},
                                                                                  {3840, 24, 2},
                                                                                  {3840, 25, 4},
                                                                                  {8192, 48, 4}}) {
    EXPECT_EQ(coarse_factor(options, width, disparities), factor) << width << ", " << disparities;
  }
  options.factor = 8;
  EXPECT_EQ(coarse_factor(options, 640, 13), 8);
  EXPECT_EQ(factor_with_fractions(8, 64), 8);
  EXPECT_EQ(factor_with_fractions(8, 13), 4) << "4 disparities, of which the first and the last have no fraction";
  EXPECT_EQ(factor_with_fractions(4, 7), 2);
}

TEST(CoarseSearch, UnrelatedImagesGiveWideRanges) {
  const auto one = test::textured_pair(
      256, 192, [](double, double) { return 0; }, 1);
  const auto other = test::textured_pair(
      256, 192, [](double, double) { return 0; }, 99);
  CoarseSearch search({}, 1);
  ASSERT_TRUE(search.find({one.reference, other.target, nullptr, 40}, no_road));
  const SearchRanges* ranges = search.ranges();
  ASSERT_NE(ranges, nullptr);
  EXPECT_GE(ranges->reference(0, 0).end - ranges->reference(0, 0).first, 32);
  EXPECT_GE(ranges->target(0, 0).end - ranges->target(0, 0).first, 32);
}

TEST(CoarseSearch, RangesHoldRaisedObject) {
  // Road at 20, a block 48 pixels wide at 34, within one tile.
  const auto pair =
      test::textured_pair(256, 192, [](double u, double v) { return u > 80 && u < 128 && v > 30 && v < 70 ? 34 : 20; });
  CoarseSearch search({}, 1);
  ASSERT_TRUE(search.find({pair.reference, pair.target, nullptr, 48}, shift_of({20, 0, 0}, 20)));
  const SearchRanges* ranges = search.ranges();
  ASSERT_NE(ranges, nullptr);
  EXPECT_LE(ranges->reference(0, 0).first, 19);
  EXPECT_GE(ranges->reference(0, 0).end, 36);
  EXPECT_LE(ranges->reference(0, 1).first, 19);
  EXPECT_LE(ranges->reference(0, 1).end, 30);
}

TEST(CoarseSearch, FewDisparitiesGivePriorWithoutRanges) {
  const auto pair = test::textured_pair(256, 192, [](double, double) { return 4; });
  CoarseSearch search({}, 1);
  ASSERT_TRUE(search.find({pair.reference, pair.target, nullptr, 48}, no_road));
  ASSERT_NE(search.ranges(), nullptr);
  ASSERT_TRUE(search.find({pair.reference, pair.target, nullptr, 8}, no_road));
  EXPECT_EQ(search.ranges(), nullptr);
  EXPECT_NEAR(search.prior().disparity(64, 48), 4, 1);
}

TEST(CoarseSearch, SkipsSmallImages) {
  const GreyImage small(100, 60, 1600);
  CoarseSearch search({}, 1);
  EXPECT_FALSE(search.find({small, small, nullptr, 64}, no_road));
  EXPECT_EQ(search.ranges(), nullptr);
}

/// Every pixel of the prior that lies at least `border` coarse pixels inside and has a counterpart of its whole block.
template <class Check>
void for_each_inside(const DisparityPrior& prior, int border, int first_column, const Check& check) {
  for (int y = border; y + border < prior.disparity.height(); ++y) {
    for (int x = first_column; x + border < prior.disparity.width(); ++x) {
      check(to_full_resolution(x, prior.factor), to_full_resolution(y, prior.factor), prior.disparity(x, y));
    }
  }
}

TEST(CoarseSearch, PriorIsNearTruth) {
  const auto truth = [](double u, double v) { return 12 + 0.02 * v + 2 * std::sin(0.04 * u); };
  const auto pair = test::textured_pair(301, 195, truth);
  for (const int factor : {2, 4}) {
    SCOPED_TRACE(factor);
    CoarseSearchOptions options;
    options.factor = factor;
    CoarseSearch search(options, 2);
    ASSERT_TRUE(search.find({pair.reference, pair.target, nullptr, 32}, no_road));
    ASSERT_EQ(search.prior().factor, factor);
    ASSERT_EQ(search.prior().disparity.width(), 301 / factor);
    ASSERT_EQ(search.prior().disparity.height(), 195 / factor);
    double squares = 0;
    int count = 0;
    for_each_inside(search.prior(), 4, 20 / factor + 4, [&](double u, double v, float found) {
      squares += std::pow(found - truth(u, v), 2);
      ++count;
    });
    EXPECT_LT(std::sqrt(squares / count), 0.3 * factor);
  }
}

TEST(CoarseSearch, PriorIsRoadWhereTextureIsMissing) {
  constexpr int picture = 10, road = 16;
  auto pair = test::textured_pair(320, 192, [](double, double) { return picture; });
  for (int v = 60; v < 140; ++v) {
    std::fill(pair.reference.row(v) + 120, pair.reference.row(v) + 240, std::int16_t{2000});
    std::fill(pair.target.row(v) + 120 - picture, pair.target.row(v) + 240 - picture, std::int16_t{2000});
  }
  CoarseSearch search({}, 2);
  ASSERT_TRUE(search.find({pair.reference, pair.target, nullptr, 32}, shift_of({road, 0, 0}, road)));
  int inside = 0, outside = 0;
  for_each_inside(search.prior(), 4, 16, [&](double u, double v, float found) {
    // The block and its gradients reach four coarse pixels, and the target's flat region begins at its own edge.
    if (u > 136 && u < 224 && v > 70 && v < 130) {
      ++inside;
      ASSERT_NEAR(found, road, 1) << u << ", " << v;
    } else if (u < 104 || u > 256 || v < 50 || v > 150) {
      ++outside;
      ASSERT_NEAR(found, picture, 1) << u << ", " << v;
    }
  });
  EXPECT_GT(inside, 1000);
  EXPECT_GT(outside, 5000);
}

TEST(MedianOfRows, RemovesStreakAndKeepsStep) {
  Image<float> map(6, 12, 8.0F), smoothed(6, 12);
  for (int u = 0; u < 6; ++u) map(u, 3) = 20;  // the streak
  for (int v = 7; v < 12; ++v) std::fill(map.row(v), map.row(v) + 6, 5.0F);
  map(2, 9) = nan;
  median_of_rows(map, 0, 12, smoothed);
  for (int v = 0; v < 12; ++v) EXPECT_EQ(smoothed(0, v), v < 7 ? 8 : 5) << v;
  EXPECT_TRUE(std::isnan(smoothed(2, 9)));
  EXPECT_EQ(smoothed(2, 8), 5);
}

TEST(FillHidden, TakesFartherNeighbour) {
  // A hole at 2 before a rim at 6: the target sees the rim at its pixels 10 and beyond, which hides the hole's last
  // four columns, whatever was found there.
  std::vector<float> row(24, 6.0F), nearest;
  std::fill(row.begin() + 4, row.begin() + 13, 2.0F);
  for (std::size_t u = 13; u < 16; ++u) row[u] = u % 2 == 0 ? 4.0F : 3.0F;
  fill_occlusions(row.data(), 24, nearest);
  for (std::size_t u = 4; u < 16; ++u) EXPECT_EQ(row[u], 2) << u;
  for (std::size_t u = 16; u < 24; ++u) EXPECT_EQ(row[u], 6) << u;
}

void expect_same(const Image<float>& a, const Image<float>& b) {
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) ASSERT_TRUE(a(x, y) == b(x, y) || (std::isnan(a(x, y)) && std::isnan(b(x, y))));
  }
}

TEST(CoarseSearch, IsIndependentOfThreads) {
  const auto pair = test::textured_pair(258, 230, [](double u, double v) { return 9 + 0.03 * v + std::sin(0.1 * u); });
  std::vector<int> first_column(230);
  for (std::size_t v = 0; v < first_column.size(); ++v) first_column[v] = static_cast<int>(v / 8);
  const MatchInput input{pair.reference, pair.target, first_column.data(), 40};
  const PerspectiveShift road = shift_of({9, 0.03, 0}, 40);
  CoarseSearch one({}, 1), three({}, 3);
  ASSERT_TRUE(one.find(input, road));
  ASSERT_TRUE(three.find(input, road));
  EXPECT_EQ(one.ranges()->reference, three.ranges()->reference);
  EXPECT_EQ(one.ranges()->target, three.ranges()->target);
  expect_same(one.prior().disparity, three.prior().disparity);
}

// Memory that is laid out as for the last frame keeps what it holds: 21 and 31 coarse disparities take 32 elements.
TEST(CoarseSearch, IsIndependentOfEarlierFrames) {
  const auto pair = test::textured_pair(258, 230, [](double u, double v) { return 9 + 0.03 * v + std::sin(0.1 * u); });
  const auto other = test::textured_pair(
      258, 230, [](double, double) { return 5; }, 9);
  CoarseSearchOptions options;
  options.factor = 2;
  CoarseSearch fresh(options, 2), used(options, 2);
  const PerspectiveShift road = shift_of({9, 0.03, 0}, 40);
  ASSERT_TRUE(used.find({other.reference, other.target, nullptr, 61}, no_road));
  ASSERT_TRUE(used.find({other.reference, other.target, nullptr, 41}, no_road));
  ASSERT_TRUE(used.find({pair.reference, pair.target, nullptr, 61}, road));
  ASSERT_TRUE(fresh.find({pair.reference, pair.target, nullptr, 61}, road));
  EXPECT_EQ(used.ranges()->reference, fresh.ranges()->reference);
  expect_same(used.prior().disparity, fresh.prior().disparity);
}

TEST(PaddedRows, KeepValuesWhileLaidOutAlike) {
  cpu::PaddedRows<float> rows;
  rows.resize(2, 0, 100);
  EXPECT_EQ(rows.row(1)[7], 0);
  rows.row(1)[7] = 3;
  rows.resize(2, 0, 100);
  EXPECT_EQ(rows.row(1)[7], 3);
  rows.resize(1, 0, 100);
  rows.resize(2, 0, 100);
  EXPECT_EQ(rows.row(1)[7], 0);
}

TEST(PaddedRows, AreMadeAnewAfterMemoryRanOut) {
  cpu::PaddedRows<float> rows;
  rows.resize(2, 0, 100);
  constexpr std::size_t too_many = std::numeric_limits<std::size_t>::max() / 512;  // of 4 bytes times 256 columns
  EXPECT_THROW(rows.resize(too_many, 0, 100), std::bad_alloc);
  rows.resize(2, 0, 100);
  EXPECT_EQ(rows.row(1)[7], 0);
}

TEST(SceneDisparities, EndAtNearestRoadQuarterOfWidthAndMatchersMost) {
  const PerspectiveShift shift{{-10, 0.25, 0}, 5};
  EXPECT_EQ(scene_disparities(shift, 640, 361), 5 + 80 + 1);
  EXPECT_EQ(scene_disparities(shift, 320, 361), 80 + 1);
  EXPECT_EQ(scene_disparities(shift, 320, 1), 1 + 1);
  EXPECT_EQ(scene_disparities(shift, 8192, 8192), 1024);
}

TEST(CoarseSearch, RejectsOptionsOutOfRange) {
  const auto refused = [](auto change) {
    CoarseSearchOptions options;
    change(options);
    EXPECT_THROW(options.validate(), Error);
  };
  EXPECT_NO_THROW(CoarseSearchOptions{}.validate());
  refused([](auto& o) { o.factor = 3; });
  refused([](auto& o) { o.block_radius = 0; });
  refused([](auto& o) { o.step_penalty = -0.1; });
  refused([](auto& o) { o.jump_penalty = nan; });
  refused([](auto& o) { o.road_prior_height_m = 101; });
  refused([](auto& o) { o.half_weight_sigma_px = 0; });
}

}  // namespace
}  // namespace roadstereo
