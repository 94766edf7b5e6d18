#include "flight/disparity_offset.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "flight/link_mean.hpp"

namespace roadstereo::cli {

std::optional<HealthFinding> disparity_offset(const std::vector<FrameLink>& links) {
  constexpr double standard_errors = 5;
  constexpr double usual_px = 0.5;  // of any rig, as odometry expects it
  std::vector<LinkValue> offsets;
  for (const FrameLink& link : links) {
    if (link.rig_offset_sd_px > 0) offsets.push_back({link.from, link.rig_offset_px, link.rig_offset_sd_px});
  }
  const std::optional<LinkMean> offset = mean_of_links(offsets);
  if (!offset) return std::nullopt;
  const double value = std::abs(offset->value), limit = std::max(standard_errors * offset->std_error, usual_px);
  if (!(value > limit)) return std::nullopt;
  return HealthFinding{
      "disparity-offset",
      value,
      limit,
      "px",
      fmt::format(
          "disparities with the calibration's offset are {:.2f} ± {:.2f} px too {} for the motion of the pictures "
          "(limit {:.2f} px), so that every depth and height is wrong; correct the offset, or recalibrate the "
          "rig",
          value, offset->std_error, offset->value > 0 ? "small" : "large", limit),
      false};
}

}  // namespace roadstereo::cli
