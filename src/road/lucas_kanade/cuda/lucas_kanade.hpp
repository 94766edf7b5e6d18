#pragma once

#include <cstdint>

#include "core/cuda/stream.hpp"
#include "road/lucas_kanade/gauss_newton.hpp"
#include "roadstereo/perspective_shift.hpp"

namespace roadstereo::cuda {

/// Enqueues lucas_kanade (roadstereo/lucas_kanade.hpp) on the device. `aligned` is another map than `disparity`;
/// `radius` is at least 1.
void lucas_kanade(const TransformedPair& pair, ImageView<const float> disparity, int radius,
                  const AlignmentSettings& settings, ImageView<float> aligned, StreamView stream);

}  // namespace roadstereo::cuda
