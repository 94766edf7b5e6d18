#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include "core/fourier.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

constexpr int side = FourierSquare::side;

/// The definition of the transform, in double precision.
std::complex<double> defined_transform(int k, int l) {
  std::complex<double> sum = 0;
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      const double angle = -2 * std::numbers::pi * (k * u + l * v) / side;
      sum += std::complex(test::lattice(u, v, 1), test::lattice(u, v, 2)) * std::polar(1.0, angle);
    }
  }
  return sum;
}

TEST(Fourier, IsTheSumOfItsDefinition) {
  const auto square = std::make_unique<FourierSquare>();
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      square->real_row(v)[u] = static_cast<float>(test::lattice(u, v, 1));
      square->imaginary_row(v)[u] = static_cast<float>(test::lattice(u, v, 2));
    }
  }
  square->transform();
  for (const auto& [k, l] : {std::pair{0, 0}, {1, 0}, {0, 1}, {5, 9}, {32, 32}, {63, 1}, {17, 48}, {40, 63}}) {
    const std::complex<double> expected = defined_transform(k, l);
    EXPECT_NEAR(square->real_row(k)[l], expected.real(), 2e-3) << k << ", " << l;
    EXPECT_NEAR(square->imaginary_row(k)[l], expected.imag(), 2e-3) << k << ", " << l;
  }
}

}  // namespace
}  // namespace roadstereo
