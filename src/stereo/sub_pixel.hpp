#pragma once

#include <cmath>

#include "core/parabola.hpp"

// What the costs around a winner say: formulas that engines of single precision share. C++17, for kernels.

namespace roadstereo {

/// The prior counts in full where the smallest cost is `prior_full_cost` − `prior_cost_offset` or more, and less where
/// a disparity correlates well: small differences of small costs say as much as large ones of large costs.
inline constexpr float prior_cost_offset = 0.02F;
inline constexpr float prior_full_cost = 0.1F;

/// A winner that leans on the prior may lie beside the minimum of the costs. Eq. subpixel then reaches as far as this,
/// pixels, where the noise is below that variance, pixels²; half a pixel elsewhere.
inline constexpr float low_noise_truncation_px = 1.5F;
inline constexpr float low_noise_variance = 0.04F;

/// Second difference of the costs below which they do not tell where their minimum is.
inline constexpr float min_curvature = 1e-6F;

/// Share of the prior's slope that counts where `best` is the smallest cost.
ROADSTEREO_HD inline float prior_share(float best) {
  return fminf(1.0F, (best + prior_cost_offset) / prior_full_cost);
}

/// What disparity `d` pays for its distance from the prior `centre`; nothing where that is NaN.
ROADSTEREO_HD inline float prior_cost(float slope, float reach, float centre, float d) {
  return centre == centre ? slope * fminf(fabsf(d - centre), reach) : 0.0F;
}

/// Where the minimum lies from the winner, pixels, and its variance, pixels² (stereo/window.hpp).
struct SubPixel {
  float offset;
  float variance;
};

/// Eq. subpixel on the costs of the disparities around the winner; no offset where they do not tell.
ROADSTEREO_HD inline SubPixel fit_parabola(float before, float best, float after, float support) {
  const float curvature = second_difference(before, best, after);
  if (!(curvature > min_curvature)) return {0.0F, INFINITY};
  const float vertex = parabola_vertex(before, best, after);
  const float noise = 2 * fmaxf(best, 0.0F) / (support * curvature);
  const float reach = noise < low_noise_variance ? low_noise_truncation_px : 0.5F;
  const float offset = fminf(fmaxf(vertex, -reach), reach);
  return {offset, noise + (vertex - offset) * (vertex - offset)};
}

}  // namespace roadstereo
