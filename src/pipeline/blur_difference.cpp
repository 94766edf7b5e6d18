#include "roadstereo/blur_difference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/fourier.hpp"
#include "core/parallel.hpp"
#include "core/require_size.hpp"
#include "roadstereo/grey_scale.hpp"

namespace roadstereo {
namespace {

constexpr int side = FourierSquare::side;
constexpr int columns = 16, rows = 8;  // of windows
constexpr int groups = 8;              // of windows, of which each is left out in turn (jackknife)
constexpr int min_windows = 16;
constexpr int frequencies = 40;                           // cycles in a window, whole
constexpr int first_signal = 2, end_signal = 26;          // the window blurs lower frequencies
constexpr int first_noise = 28, end_noise = frequencies;  // the least of these is taken for white noise
constexpr double min_contrast_grey = 0.6;                 // windows with less count less

/// Power at whole frequencies, mean over all directions.
struct PairSpectrum {
  std::array<double, frequencies> left{}, right{};
  int windows = 0;

  void add(const PairSpectrum& other, double weight) {
    for (std::size_t k = 0; k < frequencies; ++k) {
      left[k] += weight * other.left[k];
      right[k] += weight * other.right[k];
    }
    windows += other.windows;
  }
};

/// Frequencies of the bins of a transformed window, and how many bins have each. The other half of the window has the
/// same powers.
struct Radii {
  static constexpr int first_row = 1, end_row = side / 2;
  std::array<std::array<int, side>, side> of_bin{};
  std::array<int, frequencies> bins{};

  Radii() {
    for (int k = first_row; k < end_row; ++k) {
      for (int l = 0; l < side; ++l) {
        const int radius = static_cast<int>(std::lround(std::hypot(k, std::min(l, side - l))));
        of_bin[static_cast<std::size_t>(k)][static_cast<std::size_t>(l)] = std::min(radius, frequencies);
        if (radius < frequencies) ++bins[static_cast<std::size_t>(radius)];
      }
    }
  }
};

/// Hann's window, which leaves no step at the border.
std::array<float, side> taper() {
  std::array<float, side> weights{};
  for (int u = 0; u < side; ++u) {
    weights[static_cast<std::size_t>(u)] =
        static_cast<float>(0.5 - 0.5 * std::cos(2 * std::numbers::pi * (u + 1) / (side + 1)));
  }
  return weights;
}

using Window = ImageView<const std::int16_t>;

/// Whether a row or a column has one grey level.
bool has_constant_line(const Window& window) {
  for (int v = 0; v < side; ++v) {
    const std::int16_t* const row = window.row(v);
    if (std::all_of(row, row + side, [row](std::int16_t value) { return value == row[0]; })) return true;
  }
  for (int u = 0; u < side; ++u) {
    int v = 1;
    while (v < side && window(u, v) == window(u, 0)) ++v;
    if (v == side) return true;
  }
  return false;
}

bool has_masked_pixel(ImageView<const std::uint8_t> mask, int u0, int v0) {
  for (int v = v0; v < v0 + side; ++v) {
    const std::uint8_t* const row = mask.row(v) + u0;
    if (std::any_of(row, row + side, [](std::uint8_t value) { return value != 0; })) return true;
  }
  return false;
}

/// The spectra of windows at the same place of both images, by one transform: the left image is the real part.
class WindowSpectra {
 public:
  explicit WindowSpectra(const Radii& radii) : radii_(radii), taper_(taper()) {}

  /// Adds the spectra, divided by the mean power of the window.
  void add(const Window& left, const Window& right, PairSpectrum& sum) {
    load(left, [this](int v) { return square_.real_row(v); });
    load(right, [this](int v) { return square_.imaginary_row(v); });
    square_.transform();
    std::array<float, frequencies + 1> left_power{}, right_power{};  // the last one of what is beyond
    for (int k = Radii::first_row; k < Radii::end_row; ++k) {
      const float *const a = square_.real_row(k), *const b = square_.imaginary_row(k);
      const float *const c = square_.real_row(side - k), *const d = square_.imaginary_row(side - k);
      const int* const radius = radii_.of_bin[static_cast<std::size_t>(k)].data();
      for (int l = 0; l < side; ++l) {
        const int opposite = (side - l) % side;
        const float even = a[l] + c[opposite], odd = b[l] - d[opposite];
        const float other_even = a[l] - c[opposite], other_odd = b[l] + d[opposite];
        left_power[static_cast<std::size_t>(radius[l])] += even * even + odd * odd;
        right_power[static_cast<std::size_t>(radius[l])] += other_even * other_even + other_odd * other_odd;
      }
    }
    PairSpectrum of_window;
    std::copy_n(left_power.begin(), frequencies, of_window.left.begin());
    std::copy_n(right_power.begin(), frequencies, of_window.right.begin());
    const double left_sum = std::accumulate(left_power.begin(), left_power.end(), 0.0);
    const double right_sum = std::accumulate(right_power.begin(), right_power.end(), 0.0);
    constexpr double contrast = min_contrast_grey * grey_scale * side * side;
    of_window.windows = 1;
    sum.add(of_window, 1 / (std::sqrt(left_sum * right_sum) + contrast * contrast));
  }

 private:
  /// Tapered differences from the mean.
  template <class RowOf>
  void load(const Window& window, RowOf row_of) {
    double sum = 0;
    for (int v = 0; v < side; ++v) sum += std::accumulate(window.row(v), window.row(v) + side, 0);
    const auto mean = static_cast<float>(sum / (side * side));
    for (int v = 0; v < side; ++v) {
      float* const row = row_of(v);
      const float weight = taper_[static_cast<std::size_t>(v)];
      for (int u = 0; u < side; ++u) row[u] = weight * taper_[static_cast<std::size_t>(u)] * (window(u, v) - mean);
    }
  }

  const Radii& radii_;
  std::array<float, side> taper_;
  FourierSquare square_;
};

/// Slope of the logarithm of left over right power against ω², by weighted least squares; NaN where noise leaves fewer
/// than four frequencies.
double variance_of(const PairSpectrum& spectrum, const Radii& radii) {
  constexpr int min_frequencies = 4;
  constexpr double min_signal = 2;  // times the noise
  std::array<double, frequencies> left{}, right{};
  for (std::size_t k = 0; k < frequencies; ++k) {
    left[k] = spectrum.left[k] / radii.bins[k];
    right[k] = spectrum.right[k] / radii.bins[k];
  }
  const double left_noise = *std::min_element(left.begin() + first_noise, left.begin() + end_noise);
  const double right_noise = *std::min_element(right.begin() + first_noise, right.begin() + end_noise);
  double sum = 0, x = 0, y = 0, xx = 0, xy = 0;
  int used = 0;
  for (std::size_t k = first_signal; k < end_signal; ++k) {
    const double a = left[k] - left_noise, b = right[k] - right_noise;
    if (!(a > min_signal * left_noise && b > min_signal * right_noise)) continue;
    const double omega = 2 * std::numbers::pi * static_cast<double>(k) / side, weight = radii.bins[k];
    const double square = omega * omega, ratio = std::log(a / b);
    sum += weight;
    x += weight * square;
    y += weight * ratio;
    xx += weight * square * square;
    xy += weight * square * ratio;
    ++used;
  }
  if (used < min_frequencies) return std::numeric_limits<double>::quiet_NaN();
  return (sum * xy - x * y) / (sum * xx - x * x);
}

}  // namespace

BlurDifference measure_blur_difference(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                       int threads, ImageView<const std::uint8_t> mask) {
  require_one_size({left.width(), left.height()}, {right.width(), right.height()});
  require_mask_size({mask.width(), mask.height()}, {left.width(), left.height()});
  if (left.width() < side || left.height() < side) return {};
  const Radii radii;
  std::array<PairSpectrum, groups> of_group;
  parallel_for(groups, threads, [&](int group, int) {
    WindowSpectra spectra(radii);
    for (int index = group; index < columns * rows; index += groups) {
      const int u = index % columns * (left.width() - side) / (columns - 1);
      const int v = index / columns * (left.height() - side) / (rows - 1);
      const Window in_left(left.row(v) + u, side, side, left.stride());
      const Window in_right(right.row(v) + u, side, side, right.stride());
      if (!mask.empty() && has_masked_pixel(mask, u, v)) continue;
      if (has_constant_line(in_left) || has_constant_line(in_right)) continue;
      spectra.add(in_left, in_right, of_group[static_cast<std::size_t>(group)]);
    }
  });
  PairSpectrum all;
  for (const PairSpectrum& group : of_group) all.add(group, 1);
  if (all.windows < min_windows) return {};
  BlurDifference difference;
  difference.variance_px2 = variance_of(all, radii);
  double sum = 0, squares = 0;
  for (const PairSpectrum& group : of_group) {
    PairSpectrum others = all;
    others.add(group, -1);
    const double without = variance_of(others, radii);
    sum += without;
    squares += without * without;
  }
  const double spread = squares - sum * sum / groups;
  difference.stderr_px2 = std::sqrt(std::max(0.0, spread) * (groups - 1) / groups);
  if (std::isnan(difference.variance_px2) || std::isnan(spread)) return {};
  difference.variance_px2 = std::clamp(difference.variance_px2, -BlurDifference::max_px2, BlurDifference::max_px2);
  difference.windows = all.windows;
  return difference;
}

}  // namespace roadstereo
