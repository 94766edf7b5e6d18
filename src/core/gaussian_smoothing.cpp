#include "core/gaussian_smoothing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.hpp"

namespace roadstereo {
namespace {

constexpr int rows_per_band = 16;

/// The discrete Gaussian by its Fourier series, exp(−t (1 − cos ω)).
double discrete_gaussian(int index, double variance_px2) {
  constexpr int samples = 256;
  double sum = 0;
  for (int k = 0; k < samples; ++k) {
    const double omega = 2 * std::numbers::pi * k / samples;
    sum += std::exp(-variance_px2 * (1 - std::cos(omega))) * std::cos(omega * index);
  }
  return sum / samples;
}

/// Pixels `first` to `last` of a row, which compilers turn into vectors: `at(k)` points to what lies k pixels aside.
template <class At>
void smooth_pixels(const SmoothingKernel& kernel, int first, int last, At at, std::int16_t* smoothed) {
  constexpr int strip = 256;
  constexpr int half = 1 << (SmoothingKernel::fraction_bits - 1);
  std::array<int, strip> sums;
  for (; first < last; first += strip) {
    const int count = std::min(strip, last - first);
    const std::int16_t* const centre = at(0) + first;
    for (int u = 0; u < count; ++u) sums[static_cast<std::size_t>(u)] = half + kernel.weights[0] * centre[u];
    for (int k = 1; k <= kernel.radius; ++k) {
      const std::int16_t *const before = at(-k) + first, *const after = at(k) + first;
      const std::int16_t weight = kernel.weights[k];
      for (int u = 0; u < count; ++u) {
        const auto both = static_cast<std::int16_t>(before[u] + after[u]);  // products of 16 bits are vectors of SSE2
        sums[static_cast<std::size_t>(u)] += weight * both;
      }
    }
    for (int u = 0; u < count; ++u) {
      const int sum = sums[static_cast<std::size_t>(u)] >> SmoothingKernel::fraction_bits;
      smoothed[first + u] = static_cast<std::int16_t>(sum);
    }
  }
}

void smooth_along_row(const SmoothingKernel& kernel, int width, const std::int16_t* row, std::int16_t* smoothed) {
  const int first = std::min(kernel.radius, width), last = std::max(first, width - kernel.radius);
  const auto smooth_at_border = [&](int u) {
    smoothed[u] = smoothed_level(kernel, [&](int k) { return row[clamped_index(u + k, width)]; });
  };
  for (int u = 0; u < first; ++u) smooth_at_border(u);
  smooth_pixels(
      kernel, first, last, [&](int k) { return row + k; }, smoothed);
  for (int u = last; u < width; ++u) smooth_at_border(u);
}

}  // namespace

SmoothingKernel smoothing_kernel(double variance_px2) {
  SmoothingKernel kernel;
  int rest = 1 << SmoothingKernel::fraction_bits;
  for (int k = SmoothingKernel::max_radius; k > 0; --k) {
    const double share = discrete_gaussian(k, variance_px2);
    const auto weight = static_cast<std::int16_t>(std::lround(std::ldexp(share, SmoothingKernel::fraction_bits)));
    if (weight > 0 && kernel.radius == 0) kernel.radius = k;
    kernel.weights[k] = weight;
    rest -= 2 * weight;
  }
  kernel.weights[0] = static_cast<std::int16_t>(rest);
  return kernel;
}

void smooth_image(const SmoothingKernel& kernel, int threads, ImageView<std::int16_t> image,
                  ImageView<std::int16_t> between) {
  const int width = image.width(), height = image.height();
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) smooth_along_row(kernel, width, image.row(v), between.row(v));
  });
  parallel_rows(height, rows_per_band, threads, [&](int first, int last, int) {
    for (int v = first; v < last; ++v) {
      const auto at = [&](int k) { return between.row(clamped_index(v + k, height)); };
      smooth_pixels(kernel, 0, width, at, image.row(v));
    }
  });
}

}  // namespace roadstereo
