// The search around a supposed plane, on every instruction set, on pairs whose disparities are known.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "road/plane_match.hpp"
#include "road/plane_search.hpp"
#include "tests/core/every_target.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

constexpr int width = 160, height = 90;
constexpr int range = plane_match_max_range;
constexpr int pitch = 5;  // the last column of blocks ends at the last column of the image
constexpr int places = width * height / (pitch * pitch);

double true_disparity(double u, double v) {
  return 9 + 0.02 * u + 0.05 * v;
}

test::TexturedPair slanted_pair() {
  return test::textured_pair(width, height, [](double u, double v) { return true_disparity(u, v); });
}

using PlaneMatchTarget = test::EveryTarget;

// The plane is off by up to a pixel less than the search reaches.
TEST_P(PlaneMatchTarget, EveryBlockInViewIsFound) {
  const auto pair = slanted_pair();
  const SampleGrid grid = sample_grid(width, height, range, places);
  ASSERT_EQ(grid.column(grid.columns - 1), width - 1 - plane_block_half_width);
  for (const double off : {-5.7, -2.0, 0.0, 2.5, 5.7}) {
    const DisparityPlane plane{9 + off, 0.05, 0.02};
    const PlaneMatches found = match_along_plane(pair.reference, pair.target, plane, range, places, 1);
    int in_view = 0;
    const double extent = plane_search_extent(plane.a1, plane.a2, range);
    for (int i = 0; i < grid.places(); ++i) {
      const int u = grid.column(i % grid.columns), v = grid.row(i / grid.columns);
      in_view += search_in_view(u, plane.disparity(u, v), extent, width) ? 1 : 0;
    }
    EXPECT_EQ(found.tried, in_view);
    EXPECT_EQ(found.points.size(), static_cast<std::size_t>(in_view)) << off;
    for (const DisparityPoint& p : found.points) {
      EXPECT_NEAR(p.d, true_disparity(p.u, p.v), 0.2) << off << " at " << p.u << ", " << p.v;
    }
  }
}

// A cell's mean of 25 blocks: their places differ, their residuals do not.
TEST_P(PlaneMatchTarget, CellsAreFound) {
  const auto pair = slanted_pair();
  for (const double off : {-5.7, 0.0, 2.5, 5.7}) {
    const PlaneMatches found =
        match_cells_along_plane(pair.reference, pair.target, {9 + off, 0.05, 0.02}, range, places, 1);
    EXPECT_EQ(found.points.size(), static_cast<std::size_t>(found.tried));
    EXPECT_GT(found.tried, 12);
    double last_u = 0;
    for (const DisparityPoint& p : found.points) {
      EXPECT_NEAR(p.d, true_disparity(p.u, p.v), 0.1) << off << " at " << p.u << ", " << p.v;
      last_u = std::max(last_u, p.u);
    }
    EXPECT_GT(last_u, width - 6 * pitch);
  }
}

TEST_P(PlaneMatchTarget, ThreadsDoNotMatter) {
  const auto pair = slanted_pair();
  const DisparityPlane plane{10.5, 0.05, 0.02};
  for (const auto& match : {match_along_plane, match_cells_along_plane}) {
    const PlaneMatches one = match(pair.reference, pair.target, plane, range, places, 1, {});
    const PlaneMatches many = match(pair.reference, pair.target, plane, range, places, 4, {});
    EXPECT_EQ(one.tried, many.tried);
    EXPECT_EQ(one.correlations, many.correlations);
    ASSERT_EQ(one.points.size(), many.points.size());
    for (std::size_t i = 0; i < one.points.size(); ++i) EXPECT_EQ(one.points[i].d, many.points[i].d);
  }
}

TEST_P(PlaneMatchTarget, NothingIsFoundWhereNothingCanBeSeen) {
  const auto pair = slanted_pair();
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (const DisparityPlane& plane :
       {DisparityPlane{-50, 0.05, 0.02}, DisparityPlane{1e12, 0, 0}, DisparityPlane{infinite, 0, 0},
        DisparityPlane{nan, nan, nan}, DisparityPlane{0, infinite, 0}, DisparityPlane{10, 0, 0.6}}) {
    for (const auto& match : {match_along_plane, match_cells_along_plane}) {
      EXPECT_EQ(match(pair.reference, pair.target, plane, range, places, 1, {}).tried, 0) << plane.a0;
    }
  }
  const GreyImage small(9, 5, 100);
  EXPECT_EQ(match_along_plane(small, small, {2, 0, 0}, range, 10, 1).tried, 0);
}

INSTANTIATE_TEST_SUITE_P(Machine, PlaneMatchTarget, testing::ValuesIn(test::targets_of_this_machine()),
                         test::name_of_target);

}  // namespace
}  // namespace roadstereo
