#pragma once

#include "road/refinement/cuda/refinement.hpp"
#include "road/refinement/settings.hpp"

namespace roadstereo::cuda {

/// The options, which must be valid, as the kernel takes them. `support` is the number of pixels that one disparity
/// rests on.
inline RefinementSettings refinement_settings(const RefinementOptions& options, double support) {
  return {window_radius(options), options.step, mean_settings(options, support), variance_bounds(options),
          static_cast<float>(options.max_sigma_px)};
}

}  // namespace roadstereo::cuda
