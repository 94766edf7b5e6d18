#pragma once

#include "core/grey_level.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// The weights that turn the frame's samples into grey levels. Throws Error for what to_grey refuses.
GreyWeights grey_weights(const FrameView& frame, double white_level);

}  // namespace roadstereo
