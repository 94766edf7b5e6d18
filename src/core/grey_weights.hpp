#pragma once

#include "core/grey_level.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// Returns the weights of the samples of a frame. Throws Error as to_grey does.
GreyWeights grey_weights(const FrameView& frame, double white_level);

}  // namespace roadstereo
