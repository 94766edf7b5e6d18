#pragma once

#include <map>
#include <optional>
#include <vector>

#include "roadstereo/health.hpp"
#include "roadstereo/odometry.hpp"

namespace roadstereo::cli {

/// Time from the exposure of the first row of a picture to that of the last, from how the motion between two frames
/// follows the rows that a point is seen in. `times_s`: by frame, NaN unknown; if one is, the unit is a frame, else ms.
/// Returns a finding if it exceeds five standard errors and a twentieth of the time between frames. What is longer than
/// that time is no shutter: then something else is out of order.
std::optional<HealthFinding> rolling_shutter(const std::vector<FrameLink>& links, const std::map<int, double>& times_s);

}  // namespace roadstereo::cli
