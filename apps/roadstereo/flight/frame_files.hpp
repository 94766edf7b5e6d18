#pragma once

#include <optional>

#include "flight/flight_job.hpp"
#include "flight/flight_settings.hpp"

namespace roadstereo::cli {

/// Encodes one file of a frame, e.g. "disparity/000012.tiff" of frame 12 of the source.
StagedFile encode_frame_file(FrameFile file, const std::optional<StereoCalibration>& calibration, const FlightJob& job);

/// Returns the names of all possible files of a frame.
std::vector<std::string> frame_file_names(std::int64_t index);

}  // namespace roadstereo::cli
