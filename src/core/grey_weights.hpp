#pragma once

#include "core/grey_level.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// Returns the sample of white: `white_level`, or the largest of the type where that is 0. Throws Error if it is
/// neither 0 nor a sample of the type.
double white_sample(SampleType type, double white_level);

/// Returns the weights of the samples of a frame. Throws Error as to_grey does.
GreyWeights grey_weights(const FrameView& frame, double white_level);

}  // namespace roadstereo
