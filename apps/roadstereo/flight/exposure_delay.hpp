#pragma once

#include <map>
#include <optional>
#include <vector>

#include "roadstereo/health.hpp"
#include "roadstereo/odometry.hpp"

namespace roadstereo::cli {

/// Delay of the right exposure behind the left one, from how the offset of the disparities at infinity follows the turn
/// rate: offset = constant + f · delay · rate, by weighted least squares over the links. Links of one reference count
/// as one in the standard error, which is that of batches of successive references (blocking, Flyvbjerg and Petersen).
/// `times_s`: by frame, NaN unknown; if one is, the unit is a frame, else ms. Returns a finding if the delay exceeds
/// five standard errors, and more than a quarter of the rotation is in other turns than the largest one.
std::optional<HealthFinding> exposure_delay(const std::vector<FrameLink>& links, const std::map<int, double>& times_s,
                                            double focal_px);

}  // namespace roadstereo::cli
