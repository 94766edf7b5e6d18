#include <gtest/gtest.h>

#include <cmath>

#include "core/gaussian_smoothing.hpp"
#include "roadstereo/grey_scale.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

constexpr double one = 1 << SmoothingKernel::fraction_bits;

/// exp(−t) I_n(t), by the power series of the modified Bessel function.
double discrete_gaussian(int n, double t) {
  double term = std::exp(-t);
  for (int k = 1; k <= n; ++k) term *= t / 2 / k;
  double sum = 0;
  for (int k = 1; k < 200; ++k) {
    sum += term;
    term *= t * t / 4 / k / (k + n);
  }
  return sum;
}

class SmoothingVariance : public testing::TestWithParam<double> {};

TEST_P(SmoothingVariance, WeightsAreThoseOfTheDiscreteGaussian) {
  const SmoothingKernel kernel = smoothing_kernel(GetParam());
  double sum = kernel.weights[0], variance = 0;
  for (int k = 0; k <= SmoothingKernel::max_radius; ++k) {
    EXPECT_NEAR(kernel.weights[k] / one, discrete_gaussian(k, GetParam()), k == 0 ? 21 / one : 0.51 / one) << k;
    if (k == 0) continue;
    sum += 2 * kernel.weights[k];
    variance += 2 * k * k * kernel.weights[k] / one;
    EXPECT_EQ(kernel.weights[k] > 0, k <= kernel.radius) << k;
  }
  EXPECT_EQ(sum, one);
  EXPECT_NEAR(variance, GetParam(), 0.002 + 0.01 * GetParam());
}

INSTANTIATE_TEST_SUITE_P(Pixels2, SmoothingVariance, testing::Values(0.05, 0.2, 1.0, 3.0, 8.0, 16.0));

TEST(GaussianSmoothing, SpreadsAPoint) {
  constexpr int size = 61, middle = 30;
  const SmoothingKernel kernel = smoothing_kernel(4);
  GreyImage image(size, size, std::int16_t{0}), between(size, size);
  image(middle, middle) = grey_max;
  smooth_image(kernel, 1, image, between);
  for (int v = 0; v < size; ++v) {
    for (int u = 0; u < size; ++u) {
      const double expected =
          grey_max * discrete_gaussian(std::abs(u - middle), 4) * discrete_gaussian(std::abs(v - middle), 4);
      EXPECT_NEAR(image(u, v), expected, 1.1) << u << ", " << v;
    }
  }
}

/// Also in images that are smaller than the kernel.
TEST(GaussianSmoothing, KeepsAPlaneAwayFromBorders) {
  const SmoothingKernel kernel = smoothing_kernel(16);
  for (const int size : {5, 33, 100}) {
    GreyImage flat(size, size, std::int16_t{777}), ramp(size, size), between(size, size);
    for (int v = 0; v < size; ++v) {
      for (int u = 0; u < size; ++u) ramp(u, v) = static_cast<std::int16_t>(10 * u + 20 * v);
    }
    const GreyImage before = ramp, same = flat;
    smooth_image(kernel, 1, flat, between);
    EXPECT_EQ(flat, same);
    smooth_image(kernel, 1, ramp, between);
    for (int v = kernel.radius; v < size - kernel.radius; ++v) {
      for (int u = kernel.radius; u < size - kernel.radius; ++u) EXPECT_EQ(ramp(u, v), before(u, v));
    }
  }
}

TEST(GaussianSmoothing, HasTheSameBitsForAnyThreadCount) {
  const GreyImage image = test::textured_pair(517, 203, [](double, double) { return 0; }).reference;
  GreyImage one_thread = image, three_threads = image, between(517, 203);
  smooth_image(smoothing_kernel(2.5), 1, one_thread, between);
  smooth_image(smoothing_kernel(2.5), 3, three_threads, between);
  EXPECT_EQ(one_thread, three_threads);
  EXPECT_FALSE(one_thread == image);
}

}  // namespace
}  // namespace roadstereo
