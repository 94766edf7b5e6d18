#pragma once

#include "core/full_resolution.hpp"
#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Downsamples by the mean of factor × factor pixels. The rest at the right and bottom is dropped. Pixel (x, y) of it
/// has its centre at ((x + ½)·factor − ½, …) of the image.
GreyImage downsample(ImageView<const std::int16_t> image, int factor);

/// The same into an image of the right size.
void downsample(ImageView<const std::int16_t> image, int factor, ImageView<std::int16_t> small);

}  // namespace roadstereo
#pragma GCC visibility pop
