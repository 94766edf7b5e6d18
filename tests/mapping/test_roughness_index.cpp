// The golden car against Sayers' published table, sine waves, and the floor of white noise.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "roadstereo/error.hpp"
#include "roadstereo/roughness_index.hpp"

namespace roadstereo {
namespace {

// World Bank Technical Paper 46, Sayers, Gillespie and Paterson (1986): coefficients for 250 mm.
TEST(GoldenCarStep, HasPublishedCoefficientsOf250Millimetres) {
  const GoldenCarStep step = golden_car_step(0.25);
  const double transition[4][4] = {{0.9966071, 0.01091514, -0.002083275, 0.0003190145},
                                   {-0.5563045, 0.9438768, -0.8324721, 0.05064701},
                                   {0.02153176, 0.002126764, 0.7508714, 0.008221889},
                                   {3.335013, 0.3376467, -39.12763, 0.4347564}};
  const double input[4] = {0.005476107, 1.388776, 0.2275968, 35.79262};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(step.transition[i][k], transition[i][k], 2e-6 * std::abs(transition[i][k])) << i << k;
    }
    EXPECT_NEAR(step.input[i], input[i], 2e-5 * input[i]) << i;  // published in single precision
  }
}

std::vector<double> sine(double wavelength_m, double spacing_m) {
  std::vector<double> heights;
  for (double x = 0; x < 400; x += spacing_m) {
    heights.push_back(1e-3 * std::sin(2 * std::numbers::pi * x / wavelength_m));
  }
  return heights;
}

// Gain of the quarter car, |H(ω)|·2/π of a sine wave's mean magnitude, times the sinc of the 250 mm mean of the slope.
double sine_index(double wavelength_m) {
  using Complex = std::complex<double>;
  const double omega = 2 * std::numbers::pi / wavelength_m * 80 / 3.6;
  const Complex s(0, omega);
  // Mass over mass: (s² + c s + k2) zs = (c s + k2) zu; µ s² zu = k1 (y − zu) + (k2 + c s)(zs − zu).
  const Complex suspension = 63.3 + 6.0 * s;
  const Complex ratio = suspension / (s * s + suspension);
  const Complex unsprung = 653.0 / (0.15 * s * s + 653.0 + suspension * (1.0 - ratio));
  const Complex motion = (ratio - 1.0) * unsprung;
  const double smoothing_angle = std::numbers::pi * 0.25 / wavelength_m;
  const double slope =
      1e-3 * 2 * std::numbers::pi / wavelength_m * std::abs(std::sin(smoothing_angle) / smoothing_angle);
  // The index is the mean of |zs' − zu'| over time, divided by the speed; motion of the slope input is its rate.
  return 1000 * 2 / std::numbers::pi * slope * std::abs(motion);
}

TEST(RoughnessIndex, SineWavesHaveGainOfTransferFunction) {
  for (const double wavelength : {1.0, 2.0, 2.4, 5.0, 10.0, 15.0, 30.0}) {
    const double expected = sine_index(wavelength);
    EXPECT_NEAR(roughness_index(sine(wavelength, 0.05), 0.05), expected, 0.03 * expected) << wavelength;
  }
}

TEST(RoughnessIndex, FlatAndInclinedRoadsHaveNone) {
  std::vector<double> heights(1000, 12.5);
  EXPECT_NEAR(roughness_index(heights, 0.05), 0, 1e-9);
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = 0.06 * 0.05 * static_cast<double>(i);
  EXPECT_NEAR(roughness_index(heights, 0.05), 0, 1e-6);
}

TEST(RoughnessNoiseFloor, IsMeanIndexOfWhiteNoise) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 1e-3);
  for (const double spacing : {0.05, 0.25}) {
    std::vector<double> heights(static_cast<std::size_t>(2000 / spacing));
    for (double& height : heights) height = noise(random);
    const double measured = roughness_index(heights, spacing);
    EXPECT_NEAR(roughness_noise_floor(1e-3, spacing), measured, 0.04 * measured) << spacing;
  }
}

TEST(RoughnessIndex, NeedsAsManyHeightsAsItSays) {
  for (const double spacing : {0.05, 0.25, 0.4, 0.48, 0.5}) {
    const std::size_t least = min_roughness_samples(spacing);
    EXPECT_EQ(roughness_index(std::vector<double>(least, 0.0), spacing), 0) << spacing;
    EXPECT_THROW(roughness_index(std::vector<double>(least - 1, 0.0), spacing), Error) << spacing;
  }
}

TEST(RoughnessIndex, RejectsShortProfilesAndGaps) {
  std::vector<double> heights(100, 0.0);
  EXPECT_THROW(roughness_index(heights, 0.05), Error);
  heights.resize(1000, 0.0);
  heights[500] = NAN;
  EXPECT_THROW(roughness_index(heights, 0.05), Error);
  EXPECT_THROW(roughness_index(std::vector<double>(1000, 0.0), 0.6), Error);
}

}  // namespace
}  // namespace roadstereo
