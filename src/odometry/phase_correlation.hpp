#pragma once

#include <complex>
#include <vector>

namespace roadstereo {

/// Spectrum of a square image (radix-2 FFT, rows then columns). `side` is a power of two.
using Spectrum = std::vector<std::complex<float>>;
Spectrum spectrum(const std::vector<float>& cells, int side);

/// Maximum of a phase correlation.
struct CorrelationPeak {
  double x = 0, y = 0;  ///< shift of `moved` against `fixed`, cells, −side/2 … side/2
  double height = 0;    ///< standard deviations of the correlation above its mean
};

/// Returns the highest maxima of the phase correlation of two images, best first, at least `min_distance` cells apart.
std::vector<CorrelationPeak> phase_correlation(const Spectrum& fixed, const Spectrum& moved, int side, int count,
                                               int min_distance = 3);

}  // namespace roadstereo
