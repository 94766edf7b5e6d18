#pragma once

#include <optional>
#include <vector>

#include "roadstereo/health.hpp"
#include "roadstereo/odometry.hpp"

namespace roadstereo::cli {

/// Offset of the disparities of a flight at the principal point: with a wrong one the motion of the pictures does not
/// fit that of rigid points. Returns a finding if it exceeds five standard errors and half a pixel.
std::optional<HealthFinding> disparity_offset(const std::vector<FrameLink>& links);

}  // namespace roadstereo::cli
