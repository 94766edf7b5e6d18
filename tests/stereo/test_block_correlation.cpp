// The cost of a block from whole sums against the correlation written out in double precision.

#include <gtest/gtest.h>

#include <cmath>

#include "stereo/block_correlation.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

/// A block of both views, its sums, and its correlation with noise.
struct Block {
  int pixels = 0, own = 0, own_square = 0, other = 0, other_square = 0, product = 0;

  void add(int a, int b) {
    ++pixels;
    own += a;
    own_square += a * a;
    other += b;
    other_square += b * b;
    product += a * b;
  }
  double correlation(double noise) const {
    const double n = pixels, a = own / n, b = other / n;
    const double deviation_a = std::sqrt(own_square / n - a * a + noise * noise);
    const double deviation_b = std::sqrt(other_square / n - b * b + noise * noise);
    return (product / n - a * b) / (deviation_a * deviation_b);
  }
  float cost(double noise) const {
    const auto variance = static_cast<float>(noise * noise);
    return correlation_cost(block_part(own, own_square, pixels, variance),
                            block_part(other, other_square, pixels, variance), product,
                            1.0F / static_cast<float>(pixels));
  }
};

TEST(BlockCorrelation, MatchesDoublePrecision) {
  for (const int side : {3, 7, 21}) {
    for (const double noise : {0.0, 16.0}) {
      for (const double likeness : {-0.5, 0.0, 0.7, 1.0}) {
        Block block;
        for (int i = 0; i < side * side; ++i) {
          const double a = test::lattice(i, side, 1) - 0.5, b = test::lattice(i, side, 2) - 0.5;
          block.add(static_cast<int>(4000 * a), static_cast<int>(1500 + 300 * (likeness * a + b)));
        }
        EXPECT_NEAR(block.cost(noise), 1 - block.correlation(noise), 2e-5) << side << ", " << noise << ", " << likeness;
      }
    }
  }
}

TEST(BlockCorrelation, GainAndOffsetCostNothing) {
  Block block;
  for (int i = 0; i < 49; ++i) block.add(i * i - 900, 2 * (i * i) - 1500);
  EXPECT_NEAR(block.cost(0), 0, 1e-6);
}

TEST(BlockCorrelation, NoTextureCostsOne) {
  Block flat, half_flat;
  for (int i = 0; i < 49; ++i) {
    flat.add(700, -300);
    half_flat.add(i, i == 24 ? 1201 : 1200);  // a variance of a fiftieth
  }
  EXPECT_EQ(flat.cost(0), 1.0F);
  EXPECT_EQ(half_flat.cost(0), 1.0F);
}

}  // namespace
}  // namespace roadstereo
