// Smoothing of disparities by their standard errors, against the closed forms of a weighted mean.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "roadstereo/error.hpp"
#include "roadstereo/refinement.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr int width = 83, height = 71;  // no multiples of vectors or bands
constexpr double support = 100;         // pixels
constexpr DisparityPlane no_road{};

struct Refined {
  Image<float> disparity, sigma;
};

Refined refine(const Image<float>& disparity, const Image<float>& variance, const DisparityPlane& road = no_road,
               const RefinementOptions& options = {}, int threads = 1) {
  Refined refined;
  refine_disparities(disparity, variance, 1, road, support, options, threads, refined.disparity, refined.sigma);
  return refined;
}

/// Taps of a row or column of n pixels within the radius of pixel i.
int taps(int i, int n, const RefinementOptions& options) {
  int count = 0;
  for (int k = -options.radius; k <= options.radius; k += options.step) count += i + k >= 0 && i + k < n;
  return count;
}

TEST(Refinement, ConstantMapKeepsValueWithErrorOfMean) {
  constexpr double variance = 0.01;
  const RefinementOptions options{.passes = 1, .radius = 8, .step = 4};
  const Image<float> constant(width, height, 7.25F), of_all(width, height, static_cast<float>(variance));
  const Refined refined = refine(constant, of_all, no_road, options);
  // Every tap has the precision of one disparity, of which the share step² / support is its own; the theory's variances
  // are too small by half.
  const double single = variance + options.min_sigma_px * options.min_sigma_px;
  const double share = options.step * options.step / support;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double count = taps(u, width, options) * taps(v, height, options);
      ASSERT_EQ(refined.disparity(u, v), 7.25F);
      ASSERT_NEAR(refined.sigma(u, v), std::sqrt(single / std::max(1.0, count * share)), 1e-5);
    }
  }
}

// The second pass averages neighbours 8 px apart, each of which rests on the support and the first window, (5·4)²
// pixels.
TEST(Refinement, SecondPassKeepsValueWithErrorOfMean) {
  constexpr double variance = 0.01;
  const RefinementOptions options{.passes = 2, .radius = 8, .step = 4};
  const Image<float> constant(width, height, 7.25F), of_all(width, height, static_cast<float>(variance));
  const Refined refined = refine(constant, of_all, no_road, options);
  const double least = options.min_sigma_px * options.min_sigma_px;
  const double first = (variance + least) / std::max(1.0, 25 * 16.0 / support);
  const double second = (first + least) / std::max(1.0, 25 * 64.0 / (support + 400));
  EXPECT_EQ(refined.disparity(40, 30), 7.25F);
  EXPECT_NEAR(refined.sigma(40, 30), std::sqrt(second), 1e-5);
}

TEST(Refinement, WeightsNeighboursByPrecision) {
  // Columns of variance 0.04 and 0.16 in turn, whose disparities differ by far less than their errors.
  const RefinementOptions options{
      .passes = 1, .radius = 1, .step = 1, .truncation_sigmas = 100, .max_agreement_sigma_px = 10};
  Image<float> disparity(width, height), variance(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      disparity(u, v) = u % 2 == 0 ? 5.0F : 5.03F;
      variance(u, v) = u % 2 == 0 ? 0.04F : 0.16F;
    }
  }
  const Refined refined = refine(disparity, variance, no_road, options);
  const double least = options.min_sigma_px * options.min_sigma_px;
  const double even = 1 / (0.04 + least), odd = 1 / (0.16 + least);
  EXPECT_NEAR(refined.disparity(40, 30), (5.0 * even + 5.03 * 2 * odd) / (even + 2 * odd), 1e-5);
  EXPECT_NEAR(refined.disparity(41, 30), (5.0 * 2 * even + 5.03 * odd) / (2 * even + odd), 1e-5);
}

TEST(Refinement, UnknownErrorIsTakenFromAgreeingNeighbours) {
  Image<float> disparity(width, height, 5.0F), variance(width, height, 0.01F);
  disparity(40, 30) = 5.05F;
  disparity(20, 30) = 7.5F;  // four joint errors away: σ is taken as 0.6 px at most, and the pixel keeps its own
  variance(40, 30) = variance(20, 30) = std::numeric_limits<float>::infinity();
  const Refined refined = refine(disparity, variance);
  EXPECT_NEAR(refined.disparity(40, 30), 5.0, 1e-3);
  EXPECT_TRUE(std::isnan(refined.disparity(20, 30)));  // known too badly to be a measurement
  EXPECT_TRUE(std::isnan(refined.sigma(20, 30)));
}

TEST(Refinement, KeepsStepOfManySigmas) {
  Image<float> step(width, height, 4.0F);
  const Image<float> variance(width, height, 0.0025F);  // σ = 0.05 px
  for (int v = 0; v < height; ++v) std::fill(step.row(v) + 37, step.row(v) + width, 4.5F);
  EXPECT_EQ(refine(step, variance).disparity, step);
}

TEST(Refinement, ReducesNoise) {
  Image<float> noisy(width, height);
  const Image<float> variance(width, height, 0.01F);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) noisy(u, v) = static_cast<float>(9 + 0.3464 * (test::lattice(u, v, 3) - 0.5));
  }
  const Refined refined = refine(noisy, variance);  // uniform noise of σ = 0.1 px, a window of 25 taps
  double before = 0, after = 0;
  for (int v = 8; v + 8 < height; ++v) {
    for (int u = 8; u + 8 < width; ++u) {
      before += std::pow(noisy(u, v) - 9, 2);
      after += std::pow(refined.disparity(u, v) - 9, 2);
    }
  }
  EXPECT_LT(std::sqrt(after / before), 0.6);
}

TEST(Refinement, NanStaysNanWithoutWeight) {
  Image<float> disparity(width, height, 3.0F), variance(width, height, 0.01F);
  const RefinementOptions options{.passes = 1, .radius = 4, .step = 4};
  disparity(40, 30) = disparity(41, 30) = nan;
  variance(40, 30) = nan;
  const Refined refined = refine(disparity, variance, no_road, options);
  for (const int u : {40, 41}) {
    EXPECT_TRUE(std::isnan(refined.disparity(u, 30)));
    EXPECT_TRUE(std::isnan(refined.sigma(u, 30)));
  }
  const double single = 0.01 + options.min_sigma_px * options.min_sigma_px;
  EXPECT_EQ(refined.disparity(44, 34), 3.0F);
  EXPECT_NEAR(refined.sigma(44, 34), std::sqrt(single / (8 * 0.16)), 1e-5);
  EXPECT_NEAR(refined.sigma(46, 34), std::sqrt(single / (9 * 0.16)), 1e-5);
}

/// The disparities of smooth noise around a road, some of them missing.
Image<float> uneven(const DisparityPlane& road, double amplitude) {
  Image<float> map(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double height_px = amplitude * (test::smooth_noise(u, v, 5, 4) - 0.5);
      map(u, v) = test::lattice(u, v, 8) < 0.1 ? nan : static_cast<float>(road.disparity(u, v) + height_px);
    }
  }
  return map;
}

bool same(const Image<float>& a, const Image<float>& b) {
  for (int v = 0; v < a.height(); ++v) {
    for (int u = 0; u < a.width(); ++u) {
      if (a(u, v) != b(u, v) && !(std::isnan(a(u, v)) && std::isnan(b(u, v)))) return false;
    }
  }
  return true;
}

TEST(Refinement, RadiusZeroIsIdentity) {
  const Image<float> map = uneven(no_road, 0.2), variance(width, height, 0.04F);
  RefinementOptions options{.radius = 0};
  options.smoothing_px = 0;
  const Refined refined = refine(map, variance, no_road, options);
  EXPECT_TRUE(same(refined.disparity, map));
  const double single = 0.04 + options.min_sigma_px * options.min_sigma_px;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      if (!std::isnan(map(u, v))) {
        ASSERT_NEAR(refined.sigma(u, v), std::sqrt(single), 1e-5);
      }
    }
  }
}

TEST(Refinement, KeepsTiltedRoad) {
  const DisparityPlane road{12, 0.31, -0.07};
  const Image<float> plane = uneven(road, 0), variance(width, height, 0.0025F);
  const Refined refined = refine(plane, variance, road);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      if (!std::isnan(plane(u, v))) {
        ASSERT_NEAR(refined.disparity(u, v), road.disparity(u, v), 2e-5);
      }
    }
  }
}

// A surface with the second derivatives 0.02 and −0.01 px: the mean over a window with the standard deviation s is off
// by ½s² times either. A plane, and a pixel whose neighbours are unknown or outside, has no such error.
TEST(Refinement, BentSurfaceAddsToSigma) {
  const auto sigmas = [&](double across, double down, int smoothing_px) {
    Image<float> map(width, height);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        map(u, v) = static_cast<float>(40 + 0.3 * u - 0.2 * v + 0.5 * (across * u * u + down * v * v));
      }
    }
    map(30, 20) = nan;
    RefinementOptions options{.radius = 0};
    options.smoothing_px = smoothing_px;
    return refine(map, Image<float>(width, height, 0.01F), no_road, options).sigma;
  };
  const Image<float> without = sigmas(0.02, -0.01, 0);
  for (const int s : {4, 6}) {
    const Image<float> with = sigmas(0.02, -0.01, s);
    const auto expected = [&](double across, double down) {
      return std::sqrt(without(40, 30) * without(40, 30) + std::pow(0.5 * s * s, 2) * (across * across + down * down));
    };
    EXPECT_NEAR(with(40, 30), expected(0.02, -0.01), 1e-4);
    EXPECT_NEAR(with(30 + s, 20), expected(0, -0.01), 1e-4);  // its left neighbour is unknown
    EXPECT_NEAR(with(30, 20 + s), expected(0.02, 0), 1e-4);   // that above
    EXPECT_EQ(with(0, 0), without(0, 0));
    EXPECT_TRUE(std::isnan(with(30, 20)));
    EXPECT_NEAR(sigmas(0, 0, s)(40, 30), without(40, 30), 1e-5);
  }
}

TEST(Refinement, IsIndependentOfThreads) {
  const DisparityPlane road{12, 0.31, -0.07};
  const Image<float> map = uneven(road, 1), variance(width, height, 0.01F);
  const Refined one = refine(map, variance, road, {}, 1), three = refine(map, variance, road, {}, 3);
  EXPECT_TRUE(same(one.disparity, three.disparity));
  EXPECT_TRUE(same(one.sigma, three.sigma));
}

TEST(Refinement, RejectsMapsOfDifferentSize) {
  const Image<float> map(width, height, 1.0F), other(width, height - 1, 1.0F);
  EXPECT_THROW(refine(map, other), Error);
}

TEST(Refinement, RejectsOptionsOutOfRange) {
  const auto refused = [](auto change) {
    RefinementOptions options;
    change(options);
    EXPECT_THROW(options.validate(), Error);
  };
  EXPECT_NO_THROW(RefinementOptions{}.validate());
  refused([](auto& o) { o.radius = 33; });
  refused([](auto& o) { o.step = 0; });
  refused([](auto& o) { o.truncation_sigmas = std::numeric_limits<double>::quiet_NaN(); });
  refused([](auto& o) { o.min_sigma_px = 0; });
  refused([](auto& o) { o.max_agreement_sigma_px = o.min_sigma_px / 2; });
}

}  // namespace
}  // namespace roadstereo
