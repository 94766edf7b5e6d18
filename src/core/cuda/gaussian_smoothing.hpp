#pragma once

#include <cstdint>

#include "core/cuda/stream.hpp"
#include "core/gaussian_smoothing.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// Enqueues the smoothing of an image, with the same bits as on the host; `between` is scratch memory of its size.
void smooth_image(const SmoothingKernel& kernel, ImageView<std::int16_t> image, ImageView<std::int16_t> between,
                  StreamView stream);

}  // namespace roadstereo::cuda
