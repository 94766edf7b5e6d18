#pragma once

#include <cmath>
#include <cstdint>

#include "core/mid_grey.hpp"
#include "roadstereo/grey_scale.hpp"
#include "roadstereo/host_device.hpp"

// The Gauss–Newton step of one window, for the host and for kernels. C++17.

namespace roadstereo {

/// Triangle filter of five pixels along a row, times nine. Interpolation shifts finer texture by a part of its period
/// that depends on the phase, and underestimates its gradients.
constexpr int prefilter_radius = 2;
ROADSTEREO_HD inline float prefiltered(const std::int16_t* row, int u) {
  return static_cast<float>(row[u - 2] + row[u + 2] + 2 * (row[u - 1] + row[u + 1]) + 3 * row[u]);
}

/// Level that samples are relative to, which keeps the sums small.
constexpr float alignment_centre = 9.0F * mid_grey;

/// What one pixel adds to its cell, in grey levels; `weight` 0 without a disparity.
struct AlignmentSample {
  float weight = 0;
  float target = 0;      ///< T at the pixel's disparity, less alignment_centre
  float gradient = 0;    ///< ½ (L' + T'), per pixel: symmetric, so that noise in either image does not bias the step
  float difference = 0;  ///< L − T
};

/// The sample of pixel u at the residual `disparity`. Rows are prefiltered. `first`: first column of the target.
template <class Row>
ROADSTEREO_HD inline AlignmentSample alignment_sample(const Row& reference, const Row& target, int first, int width,
                                                      int u, float disparity) {
  constexpr int margin = prefilter_radius + 1;
  const float x = static_cast<float>(u) - disparity;
  // Keys' interpolation reads from one pixel before to two behind; the comparison is false for NaN.
  const bool inside = x >= static_cast<float>(first + margin) && x < static_cast<float>(width - margin - 1) &&
                      u >= margin && u < width - margin;
  if (!inside) return {};
  const int at = static_cast<int>(x);
  const float f = x - static_cast<float>(at);
  const float t0 = target[at - 1], t1 = target[at], t2 = target[at + 1], t3 = target[at + 2];
  const float linear = 0.5F * (t2 - t0);
  const float square = t0 - 2.5F * t1 + 2 * t2 - 0.5F * t3;
  const float cube = 0.5F * (t3 - t0) + 1.5F * (t1 - t2);
  const float value = t1 + f * (linear + f * (square + f * cube));
  const float before = reference[u - 1], after = reference[u + 1];
  // Both by central differences over two pixels, so that one is not sharper than the other.
  const float target_gradient = 0.5F * ((1 - f) * (t2 - t0) + f * (t3 - t1));
  return {1.0F, value - alignment_centre, 0.5F * (0.5F * (after - before) + target_gradient), reference[u] - value};
}

/// Sums of samples and of their products.
template <class Number>
struct AlignmentSums {
  Number n, t, g, r, tt, tg, tr, gg, gr, rr;

  ROADSTEREO_HD void add(const AlignmentSample& sample) {
    const Number target = sample.target, gradient = sample.gradient, difference = sample.difference;
    n += sample.weight;
    t += target;
    g += gradient;
    r += difference;
    tt += target * target;
    tg += target * gradient;
    tr += target * difference;
    gg += gradient * gradient;
    gr += gradient * difference;
    rr += difference * difference;
  }
  template <class Other>
  ROADSTEREO_HD void add(const AlignmentSums<Other>& other) {
    n += other.n;
    t += other.t;
    g += other.g;
    r += other.r;
    tt += other.tt;
    tg += other.tg;
    tr += other.tr;
    gg += other.gg;
    gr += other.gr;
    rr += other.rr;
  }
};

/// Side of a cell, pixels.
constexpr int alignment_cell = 4;

inline int alignment_cells(int pixels) {
  return (pixels + alignment_cell - 1) / alignment_cell;
}

/// The two cells around a pixel, along one axis, and the share of the second.
struct CellPlace {
  int first, second;
  float share;
};

ROADSTEREO_HD inline CellPlace cell_place(int pixel, int cells) {
  const float at = (static_cast<float>(pixel) + 0.5F) / alignment_cell - 0.5F;
  const int below = at < 0 ? -1 : static_cast<int>(at);
  return {below < 0 ? 0 : below, below + 1 < cells ? below + 1 : cells - 1, at - static_cast<float>(below)};
}

/// Number of samples that a window needs.
constexpr int min_alignment_samples = 6;

/// Correlation of L and T in a window, each with the noise of one grey level; 0 without enough samples.
template <class Number>
ROADSTEREO_HD inline float alignment_correlation(const AlignmentSums<Number>& sums) {
  constexpr float noise = 9.0F * grey_scale, noise_variance = noise * noise;
  if (!(sums.n >= min_alignment_samples)) return 0.0F;
  const Number share = 1 / sums.n, t = sums.t * share, r = sums.r * share;
  const auto tt = static_cast<float>(sums.tt * share - t * t), tr = static_cast<float>(sums.tr * share - t * r);
  const auto rr = static_cast<float>(sums.rr * share - r * r);
  const float ll = tt + 2 * tr + rr;  // L = T + (L − T)
  return (tt + tr) / sqrtf((tt + noise_variance) * (fmaxf(ll, 0.0F) + noise_variance));
}

struct AlignmentSettings {
  float max_shift;
  float bias_variance;  ///< pixels²
};

/// Shift of the residual disparity, pixels: the regression of L − T on T, 1 and the gradient, shrunk by its own
/// variance.
template <class Number>
ROADSTEREO_HD inline float alignment_shift(const AlignmentSums<Number>& sums, const AlignmentSettings& settings) {
  // The variance of rounding to 8 bits, 1/12 of a squared grey level. Windows whose filtered target varies by less,
  // black or saturated ones, would follow the last bits of later roundings.
  constexpr Number rounding_variance = Number(81 * grey_scale * grey_scale) / 12, min_curvature = 1;
  constexpr Number pixels_per_sample = Number(81) / 19;  // noise that the prefilter has correlated: (Σ w)² / Σ w²
  if (!(sums.n >= min_alignment_samples)) return 0.0F;
  const Number share = 1 / sums.n;
  const Number tt = sums.tt - sums.t * sums.t * share, tg = sums.tg - sums.t * sums.g * share;
  const Number tr = sums.tr - sums.t * sums.r * share, gg = sums.gg - sums.g * sums.g * share;
  const Number gr = sums.gr - sums.g * sums.r * share, rr = sums.rr - sums.r * sums.r * share;
  if (!(tt > rounding_variance * sums.n)) return 0.0F;
  const Number per_tt = 1 / tt;
  const Number curvature = gg - tg * tg * per_tt;
  if (!(curvature > min_curvature)) return 0.0F;
  const Number slope = (gr - tg * tr * per_tt) / curvature;
  const Number left = rr - tr * tr * per_tt - slope * slope * curvature;
  const Number noise = (left > 0 ? left : 0) * share;
  // L' is G T' when the contrast of L is G times that of T, so that the gradient is ½ (G + 1) T'.
  const Number ll = tt + 2 * tr + rr;
  const auto contrast = static_cast<float>((ll > 0 ? ll : 0) * per_tt);
  const float gradients = 0.5F * (1 + 1 / sqrtf(fmaxf(contrast, 1e-4F)));
  const auto variance = gradients * gradients * static_cast<float>(pixels_per_sample * noise / curvature);
  const float shift =
      static_cast<float>(-slope) * gradients * settings.bias_variance / (settings.bias_variance + variance);
  return fminf(fmaxf(shift, -settings.max_shift), settings.max_shift);
}

}  // namespace roadstereo
