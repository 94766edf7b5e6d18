#pragma once

#include <cstdint>

#include "core/cuda/stream.hpp"
#include "roadstereo/image_view.hpp"
#include "stereo/finish_disparity.hpp"

namespace roadstereo::cuda {

/// Left–right check, eq. (12), and sub-pixel disparity, row by row. With `project`, the winners of the target are those
/// of the reference, projected. `offset`: to the winner, NaN without two neighbours. `variance` grows where the check
/// fails. `pixel_step`: pixels from one winner to the next.
void finish_rows(ImageView<const std::int16_t> winner, ImageView<std::int16_t> target_winner,
                 ImageView<const float> offset, const FinishSettings& settings, bool project, int pixel_step,
                 ImageView<float> disparity, ImageView<float> variance, StreamView stream);

}  // namespace roadstereo::cuda
