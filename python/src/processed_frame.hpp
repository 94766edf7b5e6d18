#pragma once

#include <optional>

#include "roadstereo/calibration.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo::python {

/// The result of one pair, with what finding damage in it needs.
struct ProcessedFrame {
  FrameResult result;
  std::optional<StereoCalibration> calibration;
  PipelineOptions options;
};

}  // namespace roadstereo::python
