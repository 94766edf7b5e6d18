// Shifts of noise, which are known.

#include <gtest/gtest.h>

#include <complex>
#include <numbers>
#include <random>

#include "odometry/phase_correlation.hpp"

namespace roadstereo {
namespace {

constexpr int side = 32;

std::vector<float> noise(unsigned seed) {
  std::mt19937 generator(seed);
  std::vector<float> cells(side * side);
  for (float& cell : cells) cell = static_cast<float>(generator() % 1000) / 1000;
  return cells;
}

TEST(Spectrum, FollowsDefinition) {
  const std::vector<float> cells = noise(1);
  const Spectrum fast = spectrum(cells, side);
  for (const auto& [kx, ky] : {std::pair{0, 0}, {1, 0}, {3, 7}, {16, 31}}) {
    std::complex<double> sum = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const double angle = -2 * std::numbers::pi * (kx * x + ky * y) / side;
        sum += double{cells[static_cast<std::size_t>(y * side + x)]} * std::polar(1.0, angle);
      }
    }
    const std::complex<float> value = fast[static_cast<std::size_t>(ky * side + kx)];
    EXPECT_NEAR(value.real(), sum.real(), 1e-3);
    EXPECT_NEAR(value.imag(), sum.imag(), 1e-3);
  }
}

TEST(PhaseCorrelation, FindsShift) {
  const std::vector<float> fixed = noise(2), other = noise(3);
  std::vector<float> moved(fixed.size());
  const int shift_x = 5, shift_y = -9;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int from_x = (x - shift_x + side) % side, from_y = (y - shift_y + side) % side;
      moved[static_cast<std::size_t>(y * side + x)] = fixed[static_cast<std::size_t>(from_y * side + from_x)];
    }
  }
  const std::vector<CorrelationPeak> peaks = phase_correlation(spectrum(fixed, side), spectrum(moved, side), side, 2);
  ASSERT_EQ(peaks.size(), 2U);
  EXPECT_EQ(peaks[0].x, shift_x);
  EXPECT_EQ(peaks[0].y, shift_y);
  EXPECT_GT(peaks[0].height, 20);  // 32 for equal images
  EXPECT_LT(peaks[1].height, 6);
  const auto none = phase_correlation(spectrum(fixed, side), spectrum(other, side), side, 1);
  EXPECT_LT(none.at(0).height, 6);
}

}  // namespace
}  // namespace roadstereo
