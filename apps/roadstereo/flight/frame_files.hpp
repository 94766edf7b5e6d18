#pragma once

#include <optional>

#include "flight/flight_job.hpp"
#include "flight/flight_settings.hpp"

namespace roadstereo::cli {

/// One of the files of a frame, "disparity/000012.tiff" for example; of frame 12 of the source.
StagedFile encode_frame_file(FrameFile file, const std::optional<StereoCalibration>& calibration,
                             const PipelineOptions& options, const FlightJob& job);

/// The names of all files that a frame can have.
std::vector<std::string> frame_file_names(std::int64_t index);

}  // namespace roadstereo::cli
