#pragma once

#include "pipeline/frame_stages.hpp"

namespace roadstereo::cuda {

/// All stages in a device's memory. Throws Error, with the reason, where there is no usable device.
std::unique_ptr<FrameStages> make_device_stages(const PipelineOptions& options,
                                                const std::optional<StereoCalibration>& calibration);

}  // namespace roadstereo::cuda
