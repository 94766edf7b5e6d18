#pragma once

#include <cstdint>

#include "core/cuda/stream.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// core/downsample.hpp on the device: each pixel of `small` is the mean of factor × factor of the image.
void downsample(ImageView<const std::int16_t> image, int factor, ImageView<std::int16_t> small, StreamView stream);

/// The same of two images of one size, in one launch.
void downsample(ImageView<const std::int16_t> first, ImageView<const std::int16_t> second, int factor,
                ImageView<std::int16_t> first_small, ImageView<std::int16_t> second_small, StreamView stream);

}  // namespace roadstereo::cuda
