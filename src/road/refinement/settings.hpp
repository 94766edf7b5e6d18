#pragma once

#include <algorithm>
#include <cmath>

#include "road/refinement/measured.hpp"
#include "road/refinement/refinement_pass.hpp"
#include "roadstereo/refinement.hpp"

// Converts RefinementOptions to the parameters of the kernels.

namespace roadstereo {

/// The options for maps of every `pixel_step`-th row and column, in pixels of those maps; distances are rounded up.
inline RefinementOptions of_matched_pixels(const RefinementOptions& options, int pixel_step) {
  const auto matched = [pixel_step](int pixels) { return (pixels + pixel_step - 1) / pixel_step; };
  RefinementOptions scaled = options;
  scaled.step = matched(options.step);
  scaled.radius = options.radius / options.step * scaled.step;
  scaled.smoothing_px = matched(options.smoothing_px);
  return scaled;
}

/// The road in the coordinates of such maps.
inline DisparityPlane of_matched_pixels(const DisparityPlane& road, int pixel_step) {
  return {road.a0, road.a1 * pixel_step, road.a2 * pixel_step};
}

/// Effective samples of a disparity, in pixels of such maps.
inline double of_matched_pixels(double effective_samples, int pixel_step) {
  return effective_samples / (pixel_step * pixel_step);
}

inline int pass_count(const RefinementOptions& options) {
  return options.radius < options.step ? 1 : options.passes;
}

/// Pass `index` of `pass_count`. `effective_samples`: number of pixels that one disparity rests on before the first.
inline RefinementPass refinement_pass(const RefinementOptions& options, int index, double effective_samples) {
  const int neighbours = 2 * (options.radius / options.step) + 1;  // along each side
  double samples = effective_samples;
  for (int k = 0; k < index; ++k) samples += std::pow(neighbours * (options.step << k), 2);
  const int step = options.step << index;
  return {options.radius / options.step * step,
          step,
          MeanSettings{static_cast<float>(options.truncation_sigmas * options.truncation_sigmas),
                       static_cast<float>(std::min(1.0, step * step / samples))},
          SlopeSettings{std::min(options.step, max_slope_step), static_cast<float>(std::max(1.0, samples))},
          index == 0 && options.radius >= options.step,
          index + 1 == pass_count(options)};
}

inline VarianceBounds variance_bounds(const RefinementOptions& options) {
  return {static_cast<float>(options.min_sigma_px * options.min_sigma_px),
          static_cast<float>(options.max_agreement_sigma_px * options.max_agreement_sigma_px)};
}

}  // namespace roadstereo
