#pragma once

#include <optional>

#include "road/cuda/verification_statistics.hpp"
#include "roadstereo/road_model.hpp"

namespace roadstereo::cuda {

/// The rest of verify_road_model(), on the host: what the statistics of RoadVerification say of the last frame's model
/// on a pair of width × height pixels. Takes what it does from the same functions.
RoadModelEstimate assess_road_verification(const VerificationStatistics& statistics, const TrackedRoad& previous,
                                           int width, int height, const std::optional<StereoCalibration>& calibration,
                                           const RoadModelOptions& options);

}  // namespace roadstereo::cuda
