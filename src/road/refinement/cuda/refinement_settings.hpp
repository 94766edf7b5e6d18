#pragma once

#include "road/refinement/cuda/refinement.hpp"
#include "road/refinement/settings.hpp"

namespace roadstereo::cuda {

/// Pass `index` of the options, which must be valid, as the kernel takes it. `effective_samples` is the number of
/// pixels that one disparity rests on before the first pass.
inline RefinementSettings refinement_settings(const RefinementOptions& options, int index, double effective_samples) {
  return {refinement_pass(options, index, effective_samples), variance_bounds(options),
          static_cast<float>(options.max_sigma_px), options.smoothing_px};
}

}  // namespace roadstereo::cuda
