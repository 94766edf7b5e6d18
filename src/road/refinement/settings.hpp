#pragma once

#include <algorithm>

#include "road/refinement/mean_settings.hpp"
#include "road/refinement/measured.hpp"
#include "roadstereo/refinement.hpp"

// Converts RefinementOptions to the parameters of the kernels.

namespace roadstereo {

/// Distance of the window's outermost neighbours from its centre, pixels.
inline int window_radius(const RefinementOptions& options) {
  return options.radius / options.step * options.step;
}

/// `effective_samples`: number of pixels that one disparity rests on.
inline MeanSettings mean_settings(const RefinementOptions& options, double effective_samples) {
  return {static_cast<float>(options.truncation_sigmas * options.truncation_sigmas),
          static_cast<float>(std::min(1.0, options.step * options.step / effective_samples))};
}

inline VarianceBounds variance_bounds(const RefinementOptions& options) {
  return {static_cast<float>(options.min_sigma_px * options.min_sigma_px),
          static_cast<float>(options.max_agreement_sigma_px * options.max_agreement_sigma_px)};
}

}  // namespace roadstereo
