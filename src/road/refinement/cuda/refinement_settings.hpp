#pragma once

#include "road/refinement/cuda/refinement.hpp"
#include "road/refinement/settings.hpp"

namespace roadstereo::cuda {

/// The options, which must be valid, as the kernel takes them. `effective_samples` is the number of pixels that one
/// disparity rests on.
inline RefinementSettings refinement_settings(const RefinementOptions& options, double effective_samples) {
  return {window_radius(options), options.step, mean_settings(options, effective_samples), variance_bounds(options),
          static_cast<float>(options.max_sigma_px)};
}

}  // namespace roadstereo::cuda
