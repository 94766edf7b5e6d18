#include "odometry/phase_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace roadstereo {
namespace {

using Complex = std::complex<float>;

/// Cooley–Tukey FFT of `n` values with a stride; `sign` −1 forward, 1 backward without the factor 1/n.
class Transform {
 public:
  Transform(int n, int sign) : n_(n), twiddles_(static_cast<std::size_t>(n / 2)), line_(static_cast<std::size_t>(n)) {
    for (int i = 0; i < n / 2; ++i) {
      const double angle = sign * 2 * std::numbers::pi * i / n;
      twiddles_[static_cast<std::size_t>(i)] = {static_cast<float>(std::cos(angle)),
                                                static_cast<float>(std::sin(angle))};
    }
  }

  void run(Complex* values, int stride) {
    const auto n = static_cast<std::size_t>(n_);
    for (std::size_t i = 0, reversed = 0; i < n; ++i) {
      line_[reversed] = values[static_cast<std::ptrdiff_t>(i) * stride];
      std::size_t bit = n / 2;
      for (; bit > 0 && (reversed & bit) != 0; bit /= 2) reversed ^= bit;
      reversed |= bit;
    }
    for (std::size_t half = 1; half < n; half *= 2) {
      const std::size_t step = n / (2 * half);
      for (std::size_t first = 0; first < n; first += 2 * half) {
        for (std::size_t k = 0; k < half; ++k) {
          Complex& a = line_[first + k];
          Complex& b = line_[first + k + half];
          const Complex w = twiddles_[k * step];
          const Complex turned{b.real() * w.real() - b.imag() * w.imag(), b.real() * w.imag() + b.imag() * w.real()};
          b = a - turned;
          a += turned;
        }
      }
    }
    for (std::size_t i = 0; i < n; ++i) values[static_cast<std::ptrdiff_t>(i) * stride] = line_[i];
  }

 private:
  int n_;
  std::vector<Complex> twiddles_;
  std::vector<Complex> line_;
};

void transform(Spectrum& values, int side, int sign) {
  Transform line(side, sign);
  for (int row = 0; row < side; ++row) line.run(values.data() + static_cast<std::ptrdiff_t>(row) * side, 1);
  for (int column = 0; column < side; ++column) line.run(values.data() + column, side);
}

}  // namespace

Spectrum spectrum(const std::vector<float>& cells, int side) {
  Spectrum values(cells.begin(), cells.end());
  transform(values, side, -1);
  return values;
}

std::vector<CorrelationPeak> phase_correlation(const Spectrum& fixed, const Spectrum& moved, int side, int count,
                                               int min_distance) {
  Spectrum product(fixed.size());
  for (std::size_t i = 0; i < product.size(); ++i) {
    const Complex a = fixed[i], b = moved[i];
    const Complex cross{a.real() * b.real() + a.imag() * b.imag(), a.real() * b.imag() - a.imag() * b.real()};
    const float length = std::abs(cross);
    product[i] = length > 0 ? cross / length : Complex{};
  }
  transform(product, side, 1);
  double squares = 0;
  for (const Complex& value : product) squares += static_cast<double>(value.real()) * static_cast<double>(value.real());
  const double deviation = std::sqrt(squares / static_cast<double>(product.size()));
  std::vector<CorrelationPeak> peaks;
  const auto wrapped = [side](std::ptrdiff_t i) { return static_cast<double>(i < side / 2 ? i : i - side); };
  for (int n = 0; n < count && deviation > 0; ++n) {
    CorrelationPeak best;
    for (std::size_t i = 0; i < product.size(); ++i) {
      const double height = static_cast<double>(product[i].real()) / deviation;
      if (height <= best.height) continue;
      const double x = wrapped(static_cast<std::ptrdiff_t>(i) % side),
                   y = wrapped(static_cast<std::ptrdiff_t>(i) / side);
      const bool is_near = std::any_of(peaks.begin(), peaks.end(), [&](const CorrelationPeak& other) {
        return std::max(std::abs(other.x - x), std::abs(other.y - y)) < min_distance;
      });
      if (!is_near) best = {x, y, height};
    }
    if (best.height <= 0) break;
    peaks.push_back(best);
  }
  return peaks;
}

}  // namespace roadstereo
