// The double-precision oracle against the paper's equations worked out by hand: it is what every other engine is
// compared with, so it is compared with nothing of the project.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "roadstereo/error.hpp"
#include "roadstereo/matcher.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

/// c(p, d) of eq. (8) from its definition as one minus Pearson's correlation, over whole blocks only.
double pearson_cost(const GreyImage& ref, const GreyImage& tar, int u, int v, int d, int radius, int row_radius) {
  double n = 0, mean_r = 0, mean_t = 0;
  for (int y = -row_radius; y <= row_radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      n += 1;
      mean_r += ref(u + x, v + y);
      mean_t += tar(u + x - d, v + y);
    }
  }
  mean_r /= n;
  mean_t /= n;
  double rt = 0, rr = 0, tt = 0;
  for (int y = -row_radius; y <= row_radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      const double r = ref(u + x, v + y) - mean_r, t = tar(u + x - d, v + y) - mean_t;
      rt += r * t;
      rr += r * r;
      tt += t * t;
    }
  }
  return 1 - rt / std::sqrt(rr * tt);
}

TEST(ReferenceEngine, WinnerAndParabolaFollowCosts) {
  const auto pair = test::textured_pair(60, 40, [](double, double v) { return 4 + 0.05 * v; });
  MatcherOptions options;
  options.pixel_step = 1;
  options.block_radius = 3;
  options.aggregation_radius = 0;
  options.ncc_noise_sigma = 0;
  options.peak_fit = PeakFit::parabola;
  options.left_right_check = false;
  struct Block {
    double aspect;
    int row_radius;
    double samples;  ///< 4π s_u s_v, s² = (side² − 1) / 12, but at least its pixels
  };
  for (const Block& block :
       {Block{1, 3, 16 * std::numbers::pi}, Block{0.6, 2, 4 * std::numbers::pi * std::sqrt(8)}, Block{0.4, 1, 21}}) {
    options.block_aspect = block.aspect;
    MatchMaps maps;
    make_engine("reference", 1)->match({pair.reference, pair.target, nullptr, 12}, options, maps);
    for (int v = 5; v < 35; v += 3) {
      for (int u = 20; u < 55; u += 3) {
        double cost[12];
        int best = 0;
        for (int d = 0; d < 12; ++d) {
          cost[d] = pearson_cost(pair.reference, pair.target, u, v, d, 3, block.row_radius);
          if (cost[d] < cost[best]) best = d;
        }
        ASSERT_EQ(maps.winner(u, v), best);
        if (best == 0 || best == 11) continue;
        const double offset =
            (cost[best - 1] - cost[best + 1]) / (2 * cost[best - 1] + 2 * cost[best + 1] - 4 * cost[best]);  // eq. (13)
        ASSERT_NEAR(maps.disparity(u, v), best + offset, 1e-5);
        const double curvature = cost[best - 1] + cost[best + 1] - 2 * cost[best];
        const double variance = 2 * cost[best] / (block.samples * curvature);  // 2 E / (n K)
        ASSERT_NEAR(maps.variance(u, v), variance, 1e-5 * variance + 1e-9);
      }
    }
  }
}

TEST(ReferenceEngine, AggregationIsBilateralMeanOfCosts) {
  const auto pair = test::textured_pair(60, 40, [](double, double v) { return 5 + 0.04 * v; });
  MatcherOptions options;
  options.pixel_step = 1;
  options.block_radius = 2;
  options.block_aspect = 1;
  options.aggregation_step = 1;
  options.aggregation_radius = 1;
  options.aggregation_aspect = 1;
  options.aggregation_shape = WindowShape::disc;  // the pixel and its four neighbours
  options.sigma_space = 1.5;
  options.sigma_colour = 5.5;
  options.ncc_noise_sigma = 0;
  options.peak_fit = PeakFit::parabola;
  options.left_right_check = false;
  MatchMaps maps;
  make_engine("reference", 1)->match({pair.reference, pair.target, nullptr, 10}, options, maps);
  constexpr int neighbours[5][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  int compared = 0;
  for (int v = 6; v < 34; v += 2) {
    for (int u = 20; u < 55; u += 3) {
      double energy[10];
      int best = 0;
      for (int d = 0; d < 10; ++d) {
        double sum = 0, weights = 0;
        for (const auto& n : neighbours) {
          const double difference = (pair.reference(u, v) - pair.reference(u + n[0], v + n[1])) / 16.0;
          const double distance2 = n[0] * n[0] + n[1] * n[1];
          // eqs. (31) and (32)
          const double omega = std::exp(-distance2 / (1.5 * 1.5)) * std::exp(-difference * difference / (5.5 * 5.5));
          sum += omega * pearson_cost(pair.reference, pair.target, u + n[0], v + n[1], d, 2, 2);
          weights += omega;
        }
        energy[d] = sum / weights;
        if (energy[d] < energy[best]) best = d;
      }
      ASSERT_EQ(maps.winner(u, v), best);
      if (best == 0 || best == 9) continue;
      const double offset =
          (energy[best - 1] - energy[best + 1]) / (2 * energy[best - 1] + 2 * energy[best + 1] - 4 * energy[best]);
      ASSERT_NEAR(maps.disparity(u, v), best + offset, 1e-5);
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

/// A texture that repeats every 8 columns, seen 3 columns further left: the costs of 3, 11, 19 … are all 0.
struct Repeating {
  static constexpr int width = 100, height = 30;
  GreyImage reference{width, height}, target{width, height};

  Repeating() {
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        reference(u, v) = static_cast<std::int16_t>(4000 * test::lattice(u % 8, v, 1));
        target(u, v) = static_cast<std::int16_t>(4000 * test::lattice((u + 3) % 8, v, 1));
      }
    }
  }

  /// What every pixel far from the border takes.
  int winner(float prior, double slope, double reach) const {
    MatcherOptions options;
    options.pixel_step = 1;
    options.aggregation_radius = 0;
    options.prior_weight = slope;
    options.prior_truncation_px = reach;
    const DisparityPrior of_all{Image<float>(width / 2, height / 2, prior), 2};
    MatchMaps maps;
    make_engine("reference", 1)->match({reference, target, nullptr, 16, {}, of_all.view()}, options, maps);
    const int first = maps.winner(30, 5);
    for (int v = 5; v < 25; ++v) {
      for (int u = 30; u < 90; ++u) EXPECT_EQ(maps.winner(u, v), first);
    }
    return first;
  }
};

TEST(ReferenceEngine, PriorChoosesBetweenEqualMinima) {
  const Repeating pair;
  EXPECT_EQ(pair.winner(std::numeric_limits<float>::quiet_NaN(), 0.08, 4), 3);  // the smaller one
  EXPECT_EQ(pair.winner(11, 0, 4), 3);                                          // ignored
  EXPECT_EQ(pair.winner(9, 0.01, 100), 11);                                     // 2 px away, the other one 6
  EXPECT_EQ(pair.winner(6.9F, 0.01, 100), 3);
  EXPECT_EQ(pair.winner(7.1F, 0.01, 100), 11);
  EXPECT_EQ(pair.winner(40, 0.01, 4), 3);     // both beyond reach: as if there were none
  EXPECT_EQ(pair.winner(40, 0.01, 100), 11);  // both within
}

TEST(ReferenceEngine, PriorIsTruncated) {
  // No cost exceeds 2: within reach a slope of 10 decides alone; 0.02 · 4 decides nothing that has texture.
  const auto pair = test::textured_pair(100, 30, [](double, double) { return 3; });
  const DisparityPrior prior{Image<float>(100, 30, 11.0F), 1};
  MatcherOptions options;
  options.pixel_step = 1;
  options.left_right_check = false;
  MatchMaps maps;
  const auto winner = [&](double slope, double reach) {
    options.prior_weight = slope;
    options.prior_truncation_px = reach;
    make_engine("reference", 1)->match({pair.reference, pair.target, nullptr, 16, {}, prior.view()}, options, maps);
    return maps.winner;
  };
  const auto strong = winner(10, 100), weak = winner(0.02, 4);
  for (int v = 0; v < 30; ++v) {
    for (int u = 20; u < 100; ++u) {
      ASSERT_EQ(strong(u, v), 11);
      ASSERT_EQ(weak(u, v), 3);
    }
  }
}

/// Grey-level noise of the given standard deviation, independent from pixel to pixel.
void add_noise(GreyImage& image, double deviation, std::uint64_t seed) {
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      const double triangular = test::lattice(u, v, seed) + test::lattice(u, v, seed + 1) - 1;  // of variance 1/6
      const auto grain = static_cast<int>(std::lround(deviation * std::sqrt(6.0) * triangular * grey_scale));
      image(u, v) = static_cast<std::int16_t>(std::clamp(image(u, v) + grain, 0, grey_max));
    }
  }
}

TEST(ReferenceEngine, VarianceMatchesNoise) {
  // Without noise the parabola errs, too, at the ends of blocks; that is no matter of variance.
  auto pair = test::textured_pair(
      260, 120, [](double, double) { return 6; }, 5);
  MatcherOptions options;
  options.pixel_step = 1;
  options.block_radius = 4;
  options.aggregation_radius = 0;
  options.ncc_noise_sigma = 0;
  MatchMaps clean, noisy;
  make_engine("reference", 0)->match({pair.reference, pair.target, nullptr, 14}, options, clean);
  add_noise(pair.reference, 4, 11);
  add_noise(pair.target, 4, 21);
  make_engine("reference", 0)->match({pair.reference, pair.target, nullptr, 14}, options, noisy);
  double ratios = 0;
  int count = 0;
  for (int v = 5; v < 115; v += 3) {
    for (int u = 20; u < 250; u += 3) {
      const double error = noisy.disparity(u, v) - clean.disparity(u, v);
      if (std::isnan(error)) continue;
      ratios += error * error / noisy.variance(u, v);
      ++count;
    }
  }
  EXPECT_GT(count, 2000);
  EXPECT_NEAR(ratios / count, 1, 0.25);
}

TEST(MatcherOptions, RejectsValuesOutOfRange) {
  const auto refused = [](auto change) {
    MatcherOptions options;
    options.pixel_step = 1;
    change(options);
    EXPECT_THROW(options.validate(), Error);
  };
  EXPECT_NO_THROW(MatcherOptions{}.validate());
  refused([](auto& o) { o.prior_weight = -0.1; });
  refused([](auto& o) { o.prior_weight = std::numeric_limits<double>::quiet_NaN(); });
  refused([](auto& o) { o.prior_truncation_px = 1001; });
  refused([](auto& o) { o.aggregation_step = 3; });
}

TEST(ReferenceEngine, LeftRightCheckRemovesInconsistentPixels) {
  // Left half at 3 px, right half at 12 px: the strip that the right camera cannot see is 9 px wide.
  const auto pair = test::textured_pair(120, 40, [](double u, double) { return u < 60 ? 3 : 12; });
  MatcherOptions options;
  options.pixel_step = 1;
  options.block_radius = 2;
  options.aggregation_radius = 2;
  options.occlusion_sigma_px = 0;
  MatchMaps checked, unchecked, doubted;
  make_engine("reference", 1)->match({pair.reference, pair.target, nullptr, 20}, options, checked);
  options.occlusion_sigma_px = 1.5;
  make_engine("reference", 1)->match({pair.reference, pair.target, nullptr, 20}, options, doubted);
  options.left_right_check = false;
  make_engine("reference", 1)->match({pair.reference, pair.target, nullptr, 20}, options, unchecked);
  int removed = 0;
  for (int v = 0; v < 40; ++v) {
    for (int u = 20; u < 118; ++u) {
      const int d = checked.winner(u, v);
      const double difference = d - checked.target_winner(u - d, v);
      if (difference * difference > 1) {  // eq. (12), δr = 1
        EXPECT_TRUE(std::isnan(checked.disparity(u, v)));
        EXPECT_EQ(doubted.disparity(u, v), unchecked.disparity(u, v));
        if (!std::isinf(unchecked.variance(u, v))) {
          EXPECT_NEAR(doubted.variance(u, v), unchecked.variance(u, v) + 2.25, 1e-4);
        }
        ++removed;
      } else {
        EXPECT_EQ(std::isnan(checked.disparity(u, v)), std::isnan(unchecked.disparity(u, v)));
      }
    }
  }
  EXPECT_GT(removed, 40);
}

TEST(ReferenceEngine, GainAndOffsetHaveNoEffect) {
  const auto pair = test::textured_pair(
      80, 40, [](double, double) { return 6; }, 3, 0.5);
  GreyImage darker = pair.target;
  for (int v = 0; v < 40; ++v) {
    for (int u = 0; u < 80; ++u) darker(u, v) = static_cast<std::int16_t>(pair.target(u, v) / 2 + 100);
  }
  MatcherOptions options;
  options.pixel_step = 1;
  options.aggregation_radius = 0;
  options.ncc_noise_sigma = 0;
  MatchMaps a, b;
  make_engine("reference", 1)->match({pair.reference, pair.target, nullptr, 12}, options, a);
  make_engine("reference", 1)->match({pair.reference, darker, nullptr, 12}, options, b);
  EXPECT_EQ(a.winner, b.winner);
}

}  // namespace
}  // namespace roadstereo
