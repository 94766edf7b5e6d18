#pragma once

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Resamples a frame of at least 2×2 pixels: each pixel of the result, of the size of the maps, is that of the frame at
/// (`x`, `y`). Places beyond its outermost pixels take the nearest of these, and no value leaves the range of the
/// frame's samples.
Frame resample(const FrameView& frame, ImageView<const float> x, ImageView<const float> y, int threads);

}  // namespace roadstereo
#pragma GCC visibility pop
