#pragma once

#include <optional>
#include <string>

#include "roadstereo/calibration.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::python {

/// The result of one pair, with what finding damage in it needs.
struct ProcessedFrame {
  FrameResult result;
  std::optional<StereoCalibration> calibration;
  PipelineOptions options;
};

/// Throws Error if the maps of a result, which `whose` names, were left on the device.
inline void require_maps(const ProcessedFrame& frame, const std::string& whose) {
  if (frame.result.disparity.empty()) fail(whose, " were left on the device");
}

}  // namespace roadstereo::python
