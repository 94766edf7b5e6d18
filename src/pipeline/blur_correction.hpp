#pragma once

#include "roadstereo/blur_difference.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo {

/// Whether the blur of a pair is to be measured: in the first frame, and now and then. It is the rig's, not the road's.
bool blur_is_due(const PipelineState& carried);

/// Takes a measurement into the state, if it differs significantly from what the state has.
void update_blur(const BlurDifference& measured, PipelineState& carried);

}  // namespace roadstereo
