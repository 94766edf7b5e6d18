// What the kernels compute for one pixel, on the host: a machine without a GPU checks it against definitions in double
// precision and closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/mid_grey.hpp"
#include "road/map_sample.hpp"
#include "stereo/block_correlation.hpp"
#include "stereo/sub_pixel.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

struct Blocks {
  std::vector<int> own, other;  ///< grey values, 0 … 4080
};

/// Two blocks of n pixels that correlate to some degree.
Blocks blocks(int n, std::uint64_t seed, double contrast) {
  Blocks made;
  for (int i = 0; i < n; ++i) {
    const double shared = test::lattice(i, 0, seed), noise = test::lattice(i, 1, seed);
    made.own.push_back(static_cast<int>(4080 * (0.5 + contrast * (shared - 0.5))));
    made.other.push_back(static_cast<int>(4080 * (0.5 + contrast * (0.7 * shared + 0.3 * noise - 0.5))));
  }
  return made;
}

/// Mean and variance from their definitions.
struct Moments {
  double mean = 0, variance = 0;
  explicit Moments(const std::vector<int>& values) {
    for (const int value : values) mean += value;
    mean /= static_cast<double>(values.size());
    for (const int value : values) variance += (value - mean) * (value - mean) / static_cast<double>(values.size());
  }
};

BlockPart part_of(const std::vector<int>& values, float noise_variance) {
  int sum = 0, squares = 0;
  for (const int value : values) {
    const int centred = value - mid_grey;
    sum += centred;
    squares += centred * centred;
  }
  return block_part(sum, squares, static_cast<int>(values.size()), noise_variance);
}

class BlockCost : public testing::TestWithParam<int> {};

TEST_P(BlockCost, IsOneMinusCorrelation) {
  for (std::uint64_t seed = 1; seed < 40; ++seed) {
    for (const double noise : {0.0, 16.0}) {
      const Blocks pair = blocks(GetParam(), seed, seed % 3 == 0 ? 1.0 : 0.05);
      const Moments own(pair.own), other(pair.other);
      double covariance = 0;
      int products = 0;
      for (std::size_t i = 0; i < pair.own.size(); ++i) {
        covariance += (pair.own[i] - own.mean) * (pair.other[i] - other.mean) / static_cast<double>(pair.own.size());
        products += (pair.own[i] - mid_grey) * (pair.other[i] - mid_grey);
      }
      const double expected =
          1 - covariance / std::sqrt((own.variance + noise * noise) * (other.variance + noise * noise));
      const auto noise_variance = static_cast<float>(noise * noise);
      const float cost = correlation_cost(part_of(pair.own, noise_variance), part_of(pair.other, noise_variance),
                                          products, 1.0F / static_cast<float>(GetParam()));
      EXPECT_NEAR(cost, expected, 2e-6) << seed;
    }
  }
}

TEST_P(BlockCost, StatisticsSplitSumExactly) {
  for (std::uint64_t seed = 1; seed < 40; ++seed) {
    const Blocks pair = blocks(GetParam(), seed, 1);
    const BlockPart block = part_of(pair.own, 0);
    const Moments moments(pair.own);
    EXPECT_NEAR(block.mean + double{block.residue} / GetParam() + mid_grey, moments.mean, 1e-9);
    EXPECT_LE(std::abs(block.residue), 0.5F * static_cast<float>(GetParam()));
    EXPECT_NEAR(block.inverse_deviation * std::sqrt(moments.variance), 1, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, BlockCost, testing::Values(9, 15, 25, 121, 441));

TEST(BlockCostLimits, LargestSumsFitInt) {
  // Black against white and half of each: the largest block's sums are the largest there are.
  std::vector<int> halves(441, 0), flat(441, 4080);
  for (std::size_t i = 0; i < 220; ++i) halves[i] = 4080;
  int products = 0;
  for (const int value : halves) products += (value - mid_grey) * (value - mid_grey);
  EXPECT_NEAR(correlation_cost(part_of(halves, 0), part_of(halves, 0), products, 1.0F / 441), 0, 2e-6);
  EXPECT_EQ(correlation_cost(part_of(halves, 0), part_of(flat, 0), products, 1.0F / 441), 1);  // no texture: neutral
}

TEST(FitPeak, FindsVertex) {
  for (const float vertex : {-0.4F, -0.1F, 0.0F, 0.25F, 0.5F}) {
    const auto cost = [vertex](float d) { return 0.2F + 0.3F * (d - vertex) * (d - vertex); };
    const SubPixel found = fit_peak(cost(-1), cost(0), cost(1), 50, 0);
    EXPECT_NEAR(found.offset, vertex, 1e-6);
    EXPECT_NEAR(found.variance, 2 * cost(0) / (50 * 0.6), 1e-6);  // 2 E / (n K)
  }
}

TEST(FitPeak, WinnerBesideMinimumIsClampedUnlessPrecise) {
  const auto cost = [](float d) { return 0.1F + 0.3F * (d - 1.2F) * (d - 1.2F); };
  const SubPixel sure = fit_peak(cost(-1), cost(0), cost(1), 1000, 0);
  EXPECT_NEAR(sure.offset, 1.2, 1e-5);
  const SubPixel doubtful = fit_peak(cost(-1), cost(0), cost(1), 10, 0);
  EXPECT_EQ(doubtful.offset, 0.5F);
  EXPECT_NEAR(doubtful.variance, 2 * cost(0) / (10 * 0.6) + 0.7 * 0.7, 1e-5);
}

// Correlations of a Gaussian peak. A parabola through them finds a vertex nearer to the whole pixel.
TEST(FitPeak, GaussianIsNotPulledToWholePixels) {
  for (const float width : {0.7F, 1.0F, 2.0F}) {
    for (const float vertex : {-0.45F, -0.2F, 0.0F, 0.1F, 0.3F, 0.5F}) {
      const auto cost = [&](float d) {
        const float x = (d - vertex) / width;
        return 1 - 0.9F * std::exp(-0.5F * x * x);
      };
      const auto offset = [&](float floor) { return fit_peak(cost(-1), cost(0), cost(1), 1000, floor).offset; };
      EXPECT_NEAR(offset(1e-6F), vertex, 1e-4) << width;
      const float locking = std::abs(offset(0) - vertex);
      EXPECT_LE(std::abs(offset(0.1F) - vertex), 0.55F * locking + 1e-6F) << width << ", " << vertex;
    }
  }
}

// Costs of one and more are correlations of 0: finite, whatever they are.
TEST(FitPeak, GaussianThroughNoCorrelationIsFinite) {
  const SubPixel found = fit_peak(1.8F, 0.7F, 1.0F, 50, 0.1F);
  EXPECT_EQ(found.offset, 0) << "both neighbours have none";
  EXPECT_TRUE(std::isfinite(found.variance));
  EXPECT_GT(fit_peak(1.2F, 0.7F, 0.9F, 50, 0.1F).offset, 0);
}

TEST(FitPeak, FlatCostsGiveInfiniteVariance) {
  EXPECT_EQ(fit_peak(0.5F, 0.5F, 0.5F, 50, 0).offset, 0);
  EXPECT_TRUE(std::isinf(fit_peak(0.5F, 0.5F, 0.5F, 50, 0).variance));
  EXPECT_TRUE(std::isinf(fit_peak(0.4F, 0.5F, 0.4F, 50, 0).variance));
}

TEST(PriorCost, IsTruncatedLinear) {
  EXPECT_FLOAT_EQ(prior_cost(0.08F, 8, 10, 10, 13), 0.24F);
  EXPECT_FLOAT_EQ(prior_cost(0.08F, 8, 10, 10, 40), 0.64F);
  EXPECT_FLOAT_EQ(prior_cost(0.08F, 8, 6, 10, 13), 0.24F);
  EXPECT_FLOAT_EQ(prior_cost(0.08F, 8, 6, 10, 4), 0.16F);
  EXPECT_EQ(prior_cost(0.08F, 8, 6, 10, 7), 0);
  EXPECT_EQ(prior_cost(0.08F, 8, NAN, NAN, 13), 0);
  EXPECT_FLOAT_EQ(prior_share(0.0F), 0.2F);
  EXPECT_FLOAT_EQ(prior_share(0.04F), 0.6F);
  EXPECT_EQ(prior_share(0.5F), 1);
}

TEST(CellOf, IntegerMatchesFloatingPoint) {
  for (const int size : {1, 7, 24, 25, 360, 375, 640, 1242, 2160, 3840, 6144, 8191, 8192}) {
    for (int at = 0; at < size; ++at) {
      ASSERT_EQ(cell_of(at, size), cell_of(static_cast<double>(at), size)) << at << " of " << size;
    }
  }
}

}  // namespace
}  // namespace roadstereo
