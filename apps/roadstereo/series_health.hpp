#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadstereo/health.hpp"

namespace roadstereo::cli {

/// Standard deviation of the rows' offset from frame to frame, pixels, of successive offsets; NaN below ten steps.
double vibration_px(const std::vector<double>& row_offsets_px);

std::optional<HealthFinding> vibration_finding(double vibration_px);

/// `share`: of the pairs, 0 … 1. `advice`: what to do.
std::optional<HealthFinding> lost_pairs_finding(double share, const std::string& advice);

}  // namespace roadstereo::cli
