#pragma once

#include "core/cuda/stream.hpp"
#include "road/rig_bias_field.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// Enqueues the subtraction of the bias from every disparity, in place.
void subtract_bias(const BiasPolynomial<float>& bias, ImageView<float> disparity, StreamView stream);

}  // namespace roadstereo::cuda
