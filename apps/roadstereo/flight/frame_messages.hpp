#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "flight/flight_job.hpp"

namespace roadstereo::cli {

/// Encodes a frame whose damage is found as a chunk of flight.mcap. Throws Error naming the frame if its time is out of
/// range.
std::vector<std::uint8_t> encode_frame_messages(const std::optional<StereoCalibration>& calibration,
                                                const FlightJob& job);

}  // namespace roadstereo::cli
