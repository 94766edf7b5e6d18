#pragma once

#include "core/cuda/stream.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo::cuda {

/// Vertical median of five rows, then occlusion filling (stereo/coarse/coarse_map.hpp). `along_rows` is in coarse
/// pixels, `prior` in pixels of the full size.
void correct_rows(ImageView<const float> along_rows, int factor, ImageView<float> prior, StreamView stream);

}  // namespace roadstereo::cuda
