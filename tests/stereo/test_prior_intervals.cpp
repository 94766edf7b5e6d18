// Where the coarse map changes, the prior is an interval, by the geometry of a plane.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "roadstereo/perspective.hpp"
#include "roadstereo/synth.hpp"
#include "stereo/coarse/coarse_search.hpp"
#include "stereo/coarse/prior_intervals.hpp"

namespace roadstereo {
namespace {

constexpr int map_columns = 40, map_rows = 30, block_radius = 3;

/// Looking down from 2 m on a road of 50 pixels: a pixel is 40 mm.
PerspectiveShift two_metres_above() {
  PerspectiveShift shift;
  shift.road = {50, 0, 0};
  shift.delta_p = 12;
  shift.camera_height_m = 2;
  return shift;
}

/// A map of the road, 12 px, with a hole from column 20 and row 15 on.
DisparityPrior with_hole(float depth_px) {
  DisparityPrior prior{Image<float>(map_columns, map_rows, 12.0F), 2, Image<float>(map_columns, map_rows),
                       Image<float>(map_columns, map_rows)};
  for (int v = 15; v < map_rows; ++v)
    std::fill(prior.disparity.row(v) + 20, prior.disparity.row(v) + map_columns, 12 - depth_px);
  return prior;
}

void find_intervals(double border_height_m, DisparityPrior& prior) {
  const PerspectiveShift shift = two_metres_above();
  IntervalScratch scratch;
  find_prior_intervals(shift, PixelHeight(shift, border_height_m, 1), block_radius, 0, map_rows, scratch, prior);
}

TEST(PriorIntervals, HoldBothSidesOfBorderWithinRadius) {
  DisparityPrior prior = with_hole(2);  // 80 mm
  find_intervals(0.16, prior);
  for (int v = 0; v < map_rows; ++v) {
    for (int u = 0; u < map_columns; ++u) {
      const bool hole_near = u >= 20 - block_radius && v >= 15 - block_radius;
      const bool road_near = u < 20 + block_radius || v < 15 + block_radius;
      ASSERT_EQ(prior.low(u, v), hole_near ? 10 : 12) << u << ", " << v;
      ASSERT_EQ(prior.high(u, v), road_near ? 12 : 10) << u << ", " << v;
    }
  }
}

/// 80 mm are three quarters of 107 mm: half of the change is free. From 80 mm on none is.
TEST(PriorIntervals, HigherBordersAreNarrower) {
  DisparityPrior prior = with_hole(2);
  find_intervals(0.08 / 0.75, prior);
  EXPECT_NEAR(prior.low(18, 20), 11, 1e-5);
  EXPECT_EQ(prior.high(18, 20), 12);
  EXPECT_EQ(prior.low(21, 20), 10);
  EXPECT_NEAR(prior.high(21, 20), 11, 1e-5);
  find_intervals(0.08, prior);
  EXPECT_NEAR(prior.low(18, 20), 12, 1e-5);
  EXPECT_NEAR(prior.high(21, 20), 10, 1e-5);
}

/// A coarse pixel is 2 pixels: a change by one is noise, by 1.5 half of it counts.
TEST(PriorIntervals, NoiseOfMapIsNoBorder) {
  DisparityPrior prior = with_hole(1);
  find_intervals(0.16, prior);
  EXPECT_EQ(prior.low(18, 20), 12);
  EXPECT_EQ(prior.high(21, 20), 11);
  prior = with_hole(1.5F);
  find_intervals(0.16, prior);
  EXPECT_NEAR(prior.low(18, 20), 11.25, 1e-5);
  EXPECT_NEAR(prior.high(21, 20), 11.25, 1e-5);
}

TEST(PriorIntervals, UnknownStaysUnknownAndIsPassedOver) {
  DisparityPrior prior = with_hole(2);
  prior.disparity(5, 5) = std::numeric_limits<float>::quiet_NaN();
  find_intervals(0.16, prior);
  EXPECT_TRUE(std::isnan(prior.low(5, 5)));
  EXPECT_TRUE(std::isnan(prior.high(5, 5)));
  EXPECT_EQ(prior.low(6, 5), 12);
  EXPECT_EQ(prior.high(6, 5), 12);
}

/// The search writes them unless they are switched off; a search of the prior alone has none of an earlier one.
TEST(PriorIntervals, AreFoundWithThePrior) {
  const synth::SyntheticPair pair = synth::render(synth::named_scene("flat"));
  GreyImage left, right, target;
  std::vector<int> first_column;
  to_grey(pair.left.view(), 0, left);
  to_grey(pair.right.view(), 0, right);
  PerspectiveShift shift;
  shift.road = pair.plane;
  shift.disparities = 24;
  shift.delta_p = 12;
  transform_target(right, shift, 0, target, first_column);
  const MatchInput input{left, target, first_column.data(), shift.disparities};
  CoarseSearch search({}, 2);
  ASSERT_TRUE(search.find(input, shift));
  const DisparityPrior& prior = search.prior();
  ASSERT_EQ(prior.low.width(), prior.disparity.width());
  std::size_t inside = 0, wide = 0;
  for (int v = 0; v < prior.disparity.height(); ++v) {
    for (int u = 0; u < prior.disparity.width(); ++u) {
      inside += prior.low(u, v) <= prior.disparity(u, v) && prior.disparity(u, v) <= prior.high(u, v);
      wide += prior.high(u, v) - prior.low(u, v) > 1;
    }
  }
  EXPECT_GT(inside, 0.9 * static_cast<double>(prior.disparity.pixels()));  // the rest has no counterpart
  EXPECT_LT(wide, 0.02 * static_cast<double>(prior.disparity.pixels()));
  ASSERT_TRUE(search.find_prior(input, shift));
  EXPECT_TRUE(search.prior().low.empty());
  ASSERT_TRUE(search.find(input, shift));
  EXPECT_FALSE(search.prior().low.empty());
  CoarseSearchOptions none;
  none.border_height_m = 0;
  search.set_options(none);
  ASSERT_TRUE(search.find(input, shift));
  EXPECT_TRUE(search.prior().low.empty());
  EXPECT_TRUE(search.prior().view().high.empty());
}

}  // namespace
}  // namespace roadstereo
