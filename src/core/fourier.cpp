#include "core/fourier.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace roadstereo {
namespace {

constexpr int reversed_bits(int index) {
  int reversed = 0;
  for (int bit = 1; bit < FourierSquare::side; bit *= 2) reversed = 2 * reversed + (index & bit ? 1 : 0);
  return reversed;
}

}  // namespace

FourierSquare::FourierSquare() : cosines_{}, sines_{}, real_{}, imaginary_{} {
  for (int k = 0; k < side / 2; ++k) {
    const double angle = 2 * std::numbers::pi * k / side;
    cosines_[static_cast<std::size_t>(k)] = static_cast<float>(std::cos(angle));
    sines_[static_cast<std::size_t>(k)] = static_cast<float>(-std::sin(angle));
  }
}

void FourierSquare::transform() {
  transform_columns();
  transpose();
  transform_columns();
}

void FourierSquare::transform_columns() {
  for (int v = 0; v < side; ++v) {
    const int other = reversed_bits(v);
    if (other <= v) continue;
    std::swap_ranges(real_row(v), real_row(v) + side, real_row(other));
    std::swap_ranges(imaginary_row(v), imaginary_row(v) + side, imaginary_row(other));
  }
  for (int half = 1; half < side; half *= 2) {
    for (int v = 0; v < side; ++v) {
      if ((v & half) != 0) continue;
      const auto turn = static_cast<std::size_t>(v % half) * static_cast<std::size_t>(side / 2 / half);
      const float c = cosines_[turn], s = sines_[turn];
      float *const a = real_row(v), *const b = imaginary_row(v);
      float *const x = real_row(v + half), *const y = imaginary_row(v + half);
      for (int u = 0; u < side; ++u) {
        const float p = c * x[u] - s * y[u], q = c * y[u] + s * x[u];
        x[u] = a[u] - p;
        y[u] = b[u] - q;
        a[u] += p;
        b[u] += q;
      }
    }
  }
}

void FourierSquare::transpose() {
  for (int v = 0; v < side; ++v) {
    for (int u = v + 1; u < side; ++u) {
      std::swap(real_row(v)[u], real_row(u)[v]);
      std::swap(imaginary_row(v)[u], imaginary_row(u)[v]);
    }
  }
}

}  // namespace roadstereo
