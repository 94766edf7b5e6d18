// The kernels of the search for the road, on every instruction set, against sums written out in double precision.

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "road/coarse_match.hpp"
#include "road/row_correlation.hpp"
#include "road/strip_correlation.hpp"
#include "tests/core/every_target.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

using RoadCorrelationTarget = test::EveryTarget;

double mid(std::int16_t grey) {
  return grey - grey_max / 2.0;
}

TEST_P(RoadCorrelationTarget, StripsMatchDefinitionAtEveryColumn) {
  constexpr int u = 20, v = 11, half_width = 7, half_height = 3, first = 5, count = 21;
  const auto pair = test::textured_pair(70, 30, [](double, double) { return 4; });
  const CorrelationBlock block(pair.reference, u, v, half_width, half_height);
  Strip strip{};
  for (int y = 0; y < block.height; ++y) {
    for (int x = 0; x < count + block.width - 1; ++x) {
      strip.row(y)[x] = static_cast<float>(mid(pair.target(first + x, v + y - half_height)));
    }
  }
  StripValues inverse_deviations{}, correlations{};
  find_inverse_deviations(strip.view(), block.width, block.height, count, 1, inverse_deviations.data());
  correlate_strip(block, strip.view(), inverse_deviations.data(), count, correlations);
  for (int i = 0; i < count; ++i) {
    double l = 0, r = 0, ll = 0, rr = 0, lr = 0;
    const double n = block.width * block.height;
    for (int y = 0; y < block.height; ++y) {
      for (int x = 0; x < block.width; ++x) {
        const double a = pair.reference(u - half_width + x, v - half_height + y);
        const double b = pair.target(first + i + x, v - half_height + y);
        l += a, r += b, ll += a * a, rr += b * b, lr += a * b;
      }
    }
    const double expected = (n * lr - l * r) / std::sqrt((n * ll - l * l) * (n * rr - r * r));
    EXPECT_NEAR(correlations[static_cast<std::size_t>(i)], expected, 1e-4) << i;
  }
  // What has less texture than asked for has no correlation.
  find_inverse_deviations(strip.view(), block.width, block.height, count, grey_max, inverse_deviations.data());
  correlate_strip(block, strip.view(), inverse_deviations.data(), count, correlations);
  EXPECT_EQ(correlations[3], -1);
}

// More columns than one chunk of the function has.
TEST_P(RoadCorrelationTarget, InverseDeviationsMatchDefinition) {
  constexpr int width = 15, height = 7, count = Strip::max_counts + 40;
  constexpr std::ptrdiff_t pitch = count + width + Strip::guard;
  const auto pair = test::textured_pair(static_cast<int>(pitch), height, [](double, double) { return 4; });
  std::vector<float> values(static_cast<std::size_t>(pitch * height)), inverse(count + Strip::guard);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<float>(mid(
        pair.reference(static_cast<int>(i) % static_cast<int>(pitch), static_cast<int>(i) / static_cast<int>(pitch))));
  }
  const double min_deviation = 450;
  find_inverse_deviations({values.data(), pitch}, width, height, count, static_cast<float>(min_deviation),
                          inverse.data());
  int below = 0;
  for (int i = 0; i < count; ++i) {
    double sum = 0, squares = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const double grey = mid(pair.reference(i + x, y));
        sum += grey, squares += grey * grey;
      }
    }
    const double n = width * height, deviation = std::sqrt(squares / n - std::pow(sum / n, 2));
    if (std::abs(deviation - min_deviation) < 0.1) continue;
    below += deviation < min_deviation ? 1 : 0;
    EXPECT_NEAR(inverse[static_cast<std::size_t>(i)], deviation < min_deviation ? 0 : 1 / deviation, 1e-7) << i;
  }
  EXPECT_GT(below, 0);
  EXPECT_LT(below, count);
}

TEST_P(RoadCorrelationTarget, FirstOfTheHighestIsFound) {
  StripValues correlations{};
  correlations.fill(2);  // what lies behind the counted ones has no effect
  for (const int count : {1, 9, 15, 16, 17, 40}) {
    for (int i = 0; i < count; ++i) correlations[static_cast<std::size_t>(i)] = -0.5F;
    for (const int highest : {0, count / 2, count - 1}) {
      correlations[static_cast<std::size_t>(highest)] = correlations[static_cast<std::size_t>(count - 1)] = 0.25F;
      EXPECT_EQ(index_of_highest(correlations, count), highest) << count;
      correlations[static_cast<std::size_t>(highest)] = correlations[static_cast<std::size_t>(count - 1)] = -0.5F;
    }
  }
}

// In the middle and in two corners; from the lower right one whole vectors would leave the image.
TEST_P(RoadCorrelationTarget, BlocksLoseTheirMean) {
  const auto pair = test::textured_pair(40, 20, [](double, double) { return 4; });
  for (const auto& [half_width, half_height] : {std::pair{7, 4}, std::pair{5, 4}, std::pair{4, 3}}) {
    for (const auto& [u, v] :
         {std::pair{20, 9}, std::pair{half_width, half_height}, std::pair{39 - half_width, 19 - half_height}}) {
      const CorrelationBlock block(pair.reference, u, v, half_width, half_height);
      double sum = 0, squares = 0;
      const double n = block.width * block.height;
      for (int y = 0; y < block.height; ++y) {
        for (int x = 0; x < block.width; ++x) {
          const double grey = pair.reference(u - half_width + x, v - half_height + y);
          sum += grey, squares += grey * grey;
        }
      }
      EXPECT_NEAR(block.deviation, std::sqrt(squares / n - std::pow(sum / n, 2)), 1e-3);
      for (int y = 0; y < block.height; ++y) {
        for (int x = 0; x < block.width; ++x) {
          EXPECT_NEAR(block.values[static_cast<std::size_t>(y * block.width + x)],
                      pair.reference(u - half_width + x, v - half_height + y) - sum / n, 1e-3);
        }
      }
    }
  }
}

// The squares of its levels, 135 · 4080², would not fit into 31 bits.
TEST_P(RoadCorrelationTarget, WhiteBlockHasItsDeviation) {
  GreyImage white(40, 20, static_cast<std::int16_t>(grey_max));
  for (int v = 0; v < 20; ++v) white(20, v) = grey_max - 160;
  const CorrelationBlock block(white, 20, 9, 7, 4);
  EXPECT_NEAR(block.deviation, 160 * std::sqrt(14.0) / 15, 0.01);
  EXPECT_NEAR(block.values[0], 160.0 / 15, 0.01);
  EXPECT_NEAR(block.values[7], 160.0 / 15 - 160, 0.01);
}

TEST_P(RoadCorrelationTarget, StripsAreSampledBetweenPixels) {
  const auto pair = test::textured_pair(60, 3, [](double, double) { return 2; });
  const std::int16_t* row = pair.reference.row(1);
  constexpr int count = 23;
  for (const double step : {1.0, 0.98, 1.05, 0.7, 1.3}) {
    for (const double x : {0.0, 3.25, 17.9}) {
      Strip strip{};
      sample_strip(row, 60, x, step, count, strip.row(0));
      for (int i = 0; i < count; ++i) {
        const double at = x + i * step;
        const int whole = static_cast<int>(at);
        const double expected = mid(row[whole]) + (at - whole) * (row[whole + 1] - row[whole]);
        EXPECT_NEAR(strip.row(0)[i], expected, 0.02) << x << " + " << i << " · " << step;
      }
    }
  }
}

TEST_P(RoadCorrelationTarget, RowsMatchDefinitionAtEveryDisparity) {
  constexpr int width = 45, disparities = 9;
  constexpr std::ptrdiff_t front = 16, pitch = 64;
  const auto pair = test::textured_pair(width, 1, [](double, double) { return 4; });
  std::vector<std::int16_t> left(front + pitch), right(front + pitch);
  std::copy_n(pair.reference.row(0), width, left.data() + front);
  std::copy_n(pair.target.row(0), width, right.data() + front);
  std::vector<std::int32_t> sums(2 * row_guard + disparities * pitch);
  std::vector<float> values(disparities * pitch), left_residue(front + pitch), right_residue(front + pitch);
  std::vector<float> left_inverse(front + pitch), right_inverse(front + pitch);
  std::vector<std::int32_t> left_sum(front + pitch), right_sum(front + pitch);
  std::vector<std::int32_t> left_mean(front + pitch), right_mean(front + pitch);
  constexpr double mean = 100 - 20.0 / row_block_pixels, other_mean = 90 + 0.25;
  std::vector<std::vector<float>> best(4, std::vector<float>(front + pitch, -1));
  for (int u = row_block_half_width; u + row_block_half_width < width; ++u) {
    const auto i = static_cast<std::size_t>(front + u);
    left_sum[i] = 100 * row_block_pixels - 20, left_mean[i] = 100, left_residue[i] = -20.0f / row_block_pixels;
    right_mean[i] = 90, right_residue[i] = 0.25f;
    left_inverse[i] = 0.01f, right_inverse[i] = 0.02f;
  }
  const RowCorrelations row{values.data(), pitch, width, disparities};
  add_products(left.data() + front, right.data() + front, row, 1, sums.data() + row_guard);
  add_products(left.data() + front, right.data() + front, row, 1, sums.data() + row_guard);
  add_products(left.data() + front, right.data() + front, row, -1, sums.data() + row_guard);
  correlate_row(
      sums.data() + row_guard,
      {left_sum.data() + front, left_mean.data() + front, left_residue.data() + front, left_inverse.data() + front},
      {right_sum.data() + front, right_mean.data() + front, right_residue.data() + front, right_inverse.data() + front},
      row, {best[0].data() + front, best[1].data() + front}, {best[2].data() + front, best[3].data() + front});
  for (int u = 0; u < width; ++u) {
    double most = -1;
    for (int d = 0; d < disparities; ++d) {
      double expected = -1;
      if (u - d >= row_block_half_width && u + row_block_half_width < width) {
        double sum = 0;
        for (int x = u - row_block_half_width; x <= u + row_block_half_width; ++x) {
          sum += static_cast<double>(pair.reference(x, 0)) * pair.target(x - d, 0);
        }
        expected = (sum / row_block_pixels - mean * other_mean) * 0.01 * 0.02;
      }
      EXPECT_NEAR(values[static_cast<std::size_t>(d * pitch + u)], expected, 1e-5 * std::abs(expected) + 1e-6);
      most = std::max(most, expected);
    }
    EXPECT_NEAR(best[0][static_cast<std::size_t>(front + u)], most, 1e-5 * std::abs(most) + 1e-6);
  }
  std::vector<float> rivals(pitch);
  std::vector<float> best_disparity(pitch, 3);
  find_rivals(row, best_disparity.data(), rivals.data());
  const auto at = [&](int d) { return values[static_cast<std::size_t>(d * pitch + 20)]; };
  EXPECT_EQ(rivals[20], std::max({at(0), at(6), at(7), at(8)}));
}

/// Evidence of two images that have nothing in common, of the grey levels `base` ± 8 after downsampling.
DisparityEvidence evidence_at(int base) {
  constexpr int factor = 8, width = 120, height = 20, max_disparity_px = 64;
  const auto noise = [base](std::uint64_t seed) {
    GreyImage image(factor * width, factor * height);
    for (int v = 0; v < image.height(); ++v) {
      for (int u = 0; u < image.width(); ++u) {
        const double level = 16 * (test::lattice(u / factor, v / factor, seed) - 0.5);
        image(u, v) = static_cast<std::int16_t>(base + std::lround(level));
      }
    }
    return image;
  };
  return match_coarsely(noise(1), noise(2), factor, max_disparity_px, 1).evidence;
}

// In single precision the difference of products near 4060² was off by 2, half the variance of the noise.
TEST(MatchCoarsely, BrightPairHasEvidenceOfDarkOne) {
  const DisparityEvidence dark = evidence_at(20), bright = evidence_at(grey_max - 20);
  ASSERT_EQ(bright.disparities(), dark.disparities());
  double most = 0;
  for (int row = 0; row < dark.rows(); ++row) {
    for (int column = 0; column < dark.columns(); ++column) {
      for (int d = 0; d < dark.disparities(); ++d) {
        const double support = dark.support(row, column)[d];
        most = std::max(most, std::abs(support));
        ASSERT_NEAR(bright.support(row, column)[d], support, 0.01) << row << ", " << column << ": " << d;
      }
    }
  }
  EXPECT_GT(most, 1);
}

INSTANTIATE_TEST_SUITE_P(Machine, RoadCorrelationTarget, testing::ValuesIn(test::targets_of_this_machine()),
                         test::name_of_target);

}  // namespace
}  // namespace roadstereo
