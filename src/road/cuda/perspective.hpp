#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "core/cuda/plane.hpp"
#include "road/shift_terms.hpp"

namespace roadstereo::cuda {

/// transform_target of roadstereo/perspective.hpp on the device: shifts the rows of the target image, along themselves
/// and by the rows' offset. `first_column[v]` becomes the first column of the transformed row that lies inside the
/// target image. `white` is the highest grey level.
void transform_target(Plane<const std::int16_t> target, const ShiftTerms& shift, float white,
                      Plane<std::int16_t> transformed, int* first_column, cudaStream_t stream);

/// add_shift of roadstereo/perspective.hpp on the device. `disparity` may be `residual`.
void add_shift(Plane<const float> residual, const ShiftTerms& shift, Plane<float> disparity, cudaStream_t stream);

}  // namespace roadstereo::cuda
