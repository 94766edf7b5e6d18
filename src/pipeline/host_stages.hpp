#pragma once

#include "pipeline/frame_stages.hpp"

namespace roadstereo {

/// All stages on the host, with the engine that the options name.
std::unique_ptr<FrameStages> make_host_stages(const PipelineOptions& options,
                                              const std::optional<StereoCalibration>& calibration);

}  // namespace roadstereo
