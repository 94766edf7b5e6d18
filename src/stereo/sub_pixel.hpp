#pragma once

#include <cmath>

#include "core/parabola.hpp"

// Prior term and sub-pixel disparity, for the engines of single precision. C++17, for kernels.

namespace roadstereo {

/// The weight of the prior falls linearly with the smallest cost of the pixel below `prior_full_cost` −
/// `prior_cost_offset`: the smaller the costs, the smaller are their significant differences.
inline constexpr float prior_cost_offset = 0.02F;
inline constexpr float prior_full_cost = 0.1F;

/// With a prior the winner may lie beside the minimum of the costs. The offset is truncated at this,
/// pixels, where the noise is below that variance, pixels²; at half a pixel elsewhere.
inline constexpr float low_noise_truncation_px = 1.5F;
inline constexpr float low_noise_variance = 0.04F;

/// Second difference of the costs below which their minimum is undetermined.
inline constexpr float min_curvature = 1e-6F;

/// Share of the weight of the prior, where `best` is the smallest cost.
ROADSTEREO_HD inline float prior_share(float best) {
  return fminf(1.0F, (best + prior_cost_offset) / prior_full_cost);
}

/// Cost of the distance of disparity `d` from the prior low … high; 0 where that is NaN.
ROADSTEREO_HD inline float prior_cost(float weight, float truncation, float low, float high, float d) {
  return low == low ? weight * fminf(fmaxf(fmaxf(low - d, d - high), 0.0F), truncation) : 0.0F;
}

/// Offset of the minimum from the winner, pixels, and its variance, pixels² (stereo/window.hpp).
struct SubPixel {
  float offset;
  float variance;
};

/// Correlation of a cost, above 0 by the standard error `floor` of a correlation by chance, below which its logarithm
/// would follow noise.
template <class Real>
ROADSTEREO_HD Real raised_correlation(Real cost, Real floor) {
  const Real correlation = 1 - cost;
  return (correlation > 0 ? correlation : 0) + floor;
}

/// Position of the maximum of the Gaussian through three correlations, steps from the middle one: the vertex of the
/// parabola through −ln of them.
template <class Real>
ROADSTEREO_HD Real gaussian_vertex(Real before, Real at, Real after) {
  using std::log;
  const Real curvature = log(at * at / (before * after));
  return log(after / before) / (2 * (curvature > min_curvature ? curvature : Real{min_curvature}));
}

/// Offset of the winner from the costs around it: eq. (13) if `floor` is 0, else a Gaussian (stereo/window.hpp); offset
/// 0 and infinite variance where the curvature is too small.
ROADSTEREO_HD inline SubPixel fit_peak(float before, float best, float after, float effective_samples, float floor) {
  const float curvature = second_difference(before, best, after);
  if (!(curvature > min_curvature)) return {0.0F, INFINITY};
  const float vertex = floor > 0 ? gaussian_vertex(raised_correlation(before, floor), raised_correlation(best, floor),
                                                   raised_correlation(after, floor))
                                 : parabola_vertex(before, best, after);
  const float noise = 2 * fmaxf(best, 0.0F) / (effective_samples * curvature);
  const float max_offset = noise < low_noise_variance ? low_noise_truncation_px : 0.5F;
  const float offset = fminf(fmaxf(vertex, -max_offset), max_offset);
  return {offset, noise + (vertex - offset) * (vertex - offset)};
}

}  // namespace roadstereo
