#pragma once

#include <cstdint>

#include "core/cuda/stream.hpp"
#include "road/row_shift.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// transform_target of roadstereo/perspective.hpp on the device: shifts the rows of the target image, along themselves
/// and by the rows' offset. `first_column[v]` becomes the first column of the transformed row that lies inside the
/// target image. `white` is the highest grey level.
void transform_target(ImageView<const std::int16_t> target, const PerspectiveShift& shift, float white,
                      ImageView<std::int16_t> transformed, int* first_column, StreamView stream);

/// restore_disparity of roadstereo/perspective.hpp on the device. `disparity` may be `residual`.
void restore_disparity(ImageView<const float> residual, const PerspectiveShift& shift, int pixel_step,
                       ImageView<float> disparity, StreamView stream);

}  // namespace roadstereo::cuda
