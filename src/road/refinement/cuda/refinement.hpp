#pragma once

#include <cuda_runtime_api.h>

#include "core/cuda/plane.hpp"
#include "road/refinement/mean_settings.hpp"
#include "road/refinement/measured.hpp"
#include "road/shift_terms.hpp"

namespace roadstereo::cuda {

/// RefinementOptions as the kernel takes them (road/refinement/settings.hpp makes its parts).
struct RefinementSettings {
  int radius = 8;  ///< a multiple of `step`, 0 … 32
  int step = 4;
  MeanSettings mean;
  VarianceBounds bounds{};
  float worst_sigma = 1.4F;  ///< pixels
};

/// add_shift and refine_disparities in one pass on the device. `residual` (pixels, NaN invalid) and `variance`
/// (pixels²) are those of matching; the disparities are flat against `shift.road`, also where the shift is not enabled.
void refine_disparities(Plane<const float> residual, Plane<const float> variance, const ShiftTerms& shift,
                        const RefinementSettings& settings, Plane<float> refined, Plane<float> sigma,
                        cudaStream_t stream);

}  // namespace roadstereo::cuda
