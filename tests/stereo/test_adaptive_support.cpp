// Support against noise: the scale by its definition, and what it does to the options.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/noise_correlation.hpp"
#include "roadstereo/pipeline.hpp"
#include "stereo/adaptive_support.hpp"

namespace roadstereo {
namespace {

TEST(AdaptiveSupport, ScaleKeepsPixelsTimesSignalToNoise) {
  EXPECT_DOUBLE_EQ(support_scale(0.9), 1);
  EXPECT_DOUBLE_EQ(support_scale(1.0), 1);
  // (1 + 3 · (1 − ρ)/ρ) is 4/3 for ρ = 0.9, 4 for ρ = 0.5 and 8 for ρ = 0.3.
  EXPECT_NEAR(support_scale(0.5), std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(support_scale(0.3), std::sqrt(6.0), 1e-12);
  EXPECT_DOUBLE_EQ(support_scale(0.1), support_scale(0.3));
}

TEST(AdaptiveSupport, GrowsBlockAndPriorOfNoisyPairs) {
  MatcherOptions options;
  options.block_radius = 2;
  options.prior_weight = 0.08;
  const MatcherOptions noisy = adapt_support(options, {.correlation = 0.5});
  EXPECT_EQ(noisy.block_radius, 3);                 // 2 · √3 = 3.46
  EXPECT_DOUBLE_EQ(noisy.block_aspect, 2.0 / 3.0);  // 3 · 0.5 = 1.5 rows
  EXPECT_NEAR(noisy.prior_weight, 0.08 * std::sqrt(3.0), 1e-12);
  options.block_radius = 5;
  EXPECT_EQ(adapt_support(options, {.correlation = 0.3}).block_radius, 10);  // at most
}

/// A camera looks `pitch` below the horizon at a road 2 m beneath it: what a row and a column of the picture cover is
/// taken from where the rays of neighbouring pixels meet the road.
TEST(AdaptiveSupport, ForeshorteningIsThatOfRays) {
  constexpr double focal = 700, cx = 320, cy = 180, baseline = 0.2, camera_height = 2, v = 270, u = 320;
  for (const double pitch : {0.1, 0.35, 0.8, 1.3, std::numbers::pi / 2}) {
    const double s = std::sin(pitch), c = std::cos(pitch);
    // Road: y c + z s = height, in the camera's axes.
    const auto on_road = [&](double column, double row) {
      const double x = (column - cx) / focal, y = (row - cy) / focal, z = camera_height / (y * c + s);
      return std::array{x * z, y * z, z};
    };
    const auto distance = [](const auto& a, const auto& b) {
      return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    };
    const double row = distance(on_road(u, v + 0.01), on_road(u, v - 0.01));
    const double column = distance(on_road(u + 0.01, v), on_road(u - 0.01, v));
    // d = f B / z = B (f s + (v − cy) c) / height
    const DisparityPlane road{baseline * (focal * s - cy * c) / camera_height, baseline * c / camera_height, 0};
    EXPECT_NEAR(foreshortening(road, focal, cy, 640, 360), row / column, 1e-4) << pitch;
  }
  EXPECT_EQ(foreshortening({-50, 0.1, 0}, focal, cy, 640, 360), 1);  // behind the camera
}

TEST(AdaptiveSupport, BlocksAreAsLowAsRoadIsForeshortened) {
  const auto aspect = [](double own, double of_road) {
    MatcherOptions options;
    options.block_radius = 10;
    options.block_aspect = own;
    const MatcherOptions adapted = adapt_support(options, {0, of_road});
    EXPECT_EQ(adapted.block_radius, 10);
    return adapted.block_aspect;
  };
  EXPECT_DOUBLE_EQ(aspect(0.5, 1), 0.5);
  EXPECT_DOUBLE_EQ(aspect(0.5, 1.25), 0.4);
  EXPECT_DOUBLE_EQ(aspect(0.5, 1.22), 0.4);  // 4.1 rows
  EXPECT_DOUBLE_EQ(aspect(0.5, 100), 0.2);   // 2.2 rows at least
  EXPECT_DOUBLE_EQ(aspect(0.1, 100), 0.1);   // unless less is asked for
}

TEST(AdaptiveSupport, RadiusOfCoarseBlocks) {
  EXPECT_EQ(adapt_radius(3, 0.95), 3);
  EXPECT_EQ(adapt_radius(3, 0), 3);    // unknown
  EXPECT_EQ(adapt_radius(3, 0.5), 5);  // 3 · √3 = 5.2
  EXPECT_EQ(adapt_radius(3, 0.3), 7);  // 3 · √6 = 7.3
}

TEST(AdaptiveSupport, DownsamplingAveragesNoise) {
  EXPECT_DOUBLE_EQ(downsampled_correlation(0.5, 2), 0.8);  // signal to noise 1, and 4 afterwards
  EXPECT_DOUBLE_EQ(downsampled_correlation(0.9, 1), 0.9);
  EXPECT_EQ(downsampled_correlation(0, 2), 0);
  EXPECT_DOUBLE_EQ(full_size_correlation(0.8, 2), 0.5);
  EXPECT_EQ(full_size_correlation(0, 2), 0);
}

TEST(AdaptiveSupport, LeavesOptionsWithoutNoiseOrKnowledge) {
  const MatcherOptions options;
  EXPECT_EQ(adapt_support(options, {}).block_radius, options.block_radius);
  EXPECT_EQ(adapt_support(options, {.correlation = 0.95}).prior_weight, options.prior_weight);
  for (const char* name : {"paper", "fast"}) {
    const MatcherOptions fixed = preset(name).matcher;
    EXPECT_EQ(adapt_support(fixed, {0.3, 4}), fixed) << name;
  }
}

}  // namespace
}  // namespace roadstereo
