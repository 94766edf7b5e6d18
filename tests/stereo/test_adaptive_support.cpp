// Support against noise: the scale by its definition, and what it does to the options.

#include <gtest/gtest.h>

#include <cmath>

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
  const MatcherOptions noisy = adapt_support(options, 0.5);
  EXPECT_EQ(noisy.block_radius, 3);  // 2 · √3 = 3.46
  EXPECT_NEAR(noisy.prior_weight, 0.08 * std::sqrt(3.0), 1e-12);
  EXPECT_EQ(noisy.block_aspect, options.block_aspect);
  options.block_radius = 5;
  EXPECT_EQ(adapt_support(options, 0.3).block_radius, 10);  // at most
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
}

TEST(AdaptiveSupport, LeavesOptionsWithoutNoiseOrKnowledge) {
  const MatcherOptions options;
  EXPECT_EQ(adapt_support(options, 0).block_radius, options.block_radius);
  EXPECT_EQ(adapt_support(options, 0.95).prior_weight, options.prior_weight);
  for (const char* name : {"paper", "fast"}) {
    const MatcherOptions fixed = preset(name).matcher;
    EXPECT_EQ(adapt_support(fixed, 0.3).block_radius, fixed.block_radius) << name;
  }
}

}  // namespace
}  // namespace roadstereo
