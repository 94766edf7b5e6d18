// Pixels between those that were matched: planes are exact, edges stay edges, holes are closed from their rims.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "roadstereo/error.hpp"
#include "roadstereo/matcher.hpp"
#include "roadstereo/perspective.hpp"
#include "roadstereo/refinement.hpp"

namespace roadstereo {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

struct Interpolated {
  Image<float> disparity, sigma;
};

Interpolated interpolate(const Image<float>& disparity, const Image<float>& sigma, const DisparityPlane& road,
                         int width, int height, int threads = 1) {
  Interpolated full;
  interpolate_disparities(disparity, sigma, road, width, height, threads, full.disparity, full.sigma);
  return full;
}

/// Every second pixel of every second row of `of(u, v)`.
template <class Value>
Image<float> every_second(int width, int height, const Value& of) {
  Image<float> map((width + 1) / 2, (height + 1) / 2);
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) map(x, y) = static_cast<float>(of(2 * x, 2 * y));
  }
  return map;
}

TEST(Interpolation, RoadIsExactUpToBorders) {
  const DisparityPlane road{3, 1.5, -0.75};  // rises by more than the limit of an edge from row to row
  for (const auto& [width, height] : {std::pair{10, 8}, {11, 8}, {10, 7}, {131, 69}, {1, 1}, {2, 1}, {1, 2}}) {
    SCOPED_TRACE(testing::Message() << width << "x" << height);
    const auto road_at = [&](int u, int v) { return road.disparity(u, v); };
    const Image<float> matched = every_second(width, height, road_at);
    const Image<float> sigma(matched.width(), matched.height(), 0.1F);
    const Interpolated full = interpolate(matched, sigma, road, width, height, 2);
    ASSERT_EQ(full.disparity.width(), width);
    ASSERT_EQ(full.disparity.height(), height);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        ASSERT_NEAR(full.disparity(u, v), road_at(u, v), 1e-4) << u << ", " << v;
        ASSERT_NEAR(full.sigma(u, v), 0.1, 1e-6);
      }
    }
  }
}

TEST(Interpolation, SlopeIsLinear) {
  const auto slope = [](int u, int v) { return 5 + 0.4 * u + 0.3 * v; };  // less than the limit of an edge
  const Image<float> matched = every_second(31, 21, slope);
  const Interpolated full = interpolate(matched, Image<float>(16, 11, 0.1F), {}, 31, 21);
  for (int v = 0; v < 21; ++v) {
    for (int u = 0; u < 31; ++u) ASSERT_NEAR(full.disparity(u, v), slope(u, v), 1e-5) << u << ", " << v;
  }
}

TEST(Interpolation, EdgeTakesSideWithSmallerError) {
  Image<float> matched(6, 1, 4.0F), sigma(6, 1, 0.2F);
  for (int x = 3; x < 6; ++x) {
    matched(x, 0) = 9;
    sigma(x, 0) = 0.1F;
  }
  const Interpolated full = interpolate(matched, sigma, {}, 12, 2);
  for (int v = 0; v < 2; ++v) {
    for (int u = 0; u < 12; ++u) {
      EXPECT_EQ(full.disparity(u, v), u < 5 ? 4.0F : 9.0F) << u << ", " << v;  // pixel 5 lies between 4 and 6
      EXPECT_EQ(full.sigma(u, v), u < 5 ? 0.2F : 0.1F) << u << ", " << v;
    }
  }
}

TEST(Interpolation, HoleIsClosedFromItsRimOnly) {
  Image<float> matched(6, 3, 4.0F), sigma(6, 3, 0.2F);
  for (int x = 2; x < 4; ++x) matched(x, 1) = sigma(x, 1) = nan;
  const Interpolated full = interpolate(matched, sigma, {}, 12, 6);
  for (int v = 0; v < 6; ++v) {
    for (int u = 0; u < 12; ++u) {
      const bool hole = v == 2 && u >= 4 && u <= 6;
      EXPECT_EQ(std::isnan(full.disparity(u, v)), hole) << u << ", " << v;
      EXPECT_EQ(std::isnan(full.sigma(u, v)), hole) << u << ", " << v;
    }
  }
}

TEST(Interpolation, RestoredPixelsHaveShiftOfTheirPlaceInImage) {
  const PerspectiveShift shift{{3, 0.25, -0.125}, 6, 32};
  constexpr int width = 61, height = 47;
  const Image<float> residual(width, height, 6.5F);
  Image<float> all, matched;
  restore_disparity(residual, shift, 1, 1, all);
  restore_disparity(every_second(width, height, [&](int u, int v) { return residual(u, v); }), shift, 2, 1, matched);
  for (int y = 0; y < matched.height(); ++y) {
    for (int x = 0; x < matched.width(); ++x) ASSERT_EQ(matched(x, y), all(2 * x, 2 * y)) << x << ", " << y;
  }
}

TEST(Interpolation, MapsOfAnotherSizeAreRefused) {
  const Image<float> map(6, 3, 4.0F), narrow(5, 3, 4.0F);
  EXPECT_NO_THROW(interpolate(map, map, {}, 11, 5));
  EXPECT_THROW(interpolate(map, map, {}, 13, 5), Error);
  EXPECT_THROW(interpolate(map, map, {}, 12, 7), Error);
  EXPECT_THROW(interpolate(map, narrow, {}, 12, 6), Error);
  EXPECT_THROW(interpolate({}, {}, {}, 0, 0), Error);
  Image<float> refined, sigma;
  EXPECT_THROW(refine_disparities(map, map, 0, {}, 100, {}, 1, refined, sigma), Error);
}

// The window's neighbours are twice as far apart in the image as in the map: with even distances they are the same.
TEST(Interpolation, RefinementOfEverySecondPixelHasSameNeighbours) {
  constexpr int width = 85, height = 73;
  const DisparityPlane road{7, 0.2, -0.1};
  const auto height_at = [](int u, int v) { return 0.05 * std::sin(0.9 * u + 0.4 * v); };
  const auto variance_at = [](int u, int v) { return 0.01 + 0.0005 * ((u * 7 + v * 3) % 11); };
  Image<float> disparity(width, height), variance(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      disparity(u, v) = static_cast<float>(road.disparity(u, v) + height_at(u, v));
      variance(u, v) = static_cast<float>(variance_at(u, v));
    }
  }
  const RefinementOptions options{.passes = 2, .radius = 12, .step = 6};
  Image<float> all, all_sigma, matched, matched_sigma;
  refine_disparities(disparity, variance, 1, road, 100, options, 1, all, all_sigma);
  refine_disparities(every_second(width, height, [&](int u, int v) { return disparity(u, v); }),
                     every_second(width, height, [&](int u, int v) { return variance(u, v); }), 2, road, 100, options,
                     2, matched, matched_sigma);
  for (int y = 0; y < matched.height(); ++y) {
    for (int x = 0; x < matched.width(); ++x) {
      ASSERT_NEAR(matched(x, y), all(2 * x, 2 * y), 2e-5) << x << ", " << y;
      ASSERT_NEAR(matched_sigma(x, y), all_sigma(2 * x, 2 * y), 2e-5) << x << ", " << y;
    }
  }
}

TEST(MatcherOptions, EverySecondPixelNeedsTapsTwoApartAndOneView) {
  MatcherOptions options;
  options.aggregation_step = 1;
  EXPECT_THROW(options.validate(), Error);
  options.aggregation_radius = 0;
  EXPECT_NO_THROW(options.validate());
  options.match_both_views = true;
  EXPECT_THROW(options.validate(), Error);
  options.pixel_step = 1;
  EXPECT_NO_THROW(options.validate());
  options.pixel_step = 3;
  EXPECT_THROW(options.validate(), Error);
}

}  // namespace
}  // namespace roadstereo
