#pragma once

#include "core/cuda/stream.hpp"
#include "roadstereo/disparity_plane.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// interpolate_disparities of roadstereo/refinement.hpp on the device.
void interpolate_disparities(ImageView<const float> disparity, ImageView<const float> sigma, const DisparityPlane& road,
                             ImageView<float> full, ImageView<float> full_sigma, StreamView stream);

}  // namespace roadstereo::cuda
