#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadstereo/calibration.hpp"
#include "roadstereo/disparity_plane.hpp"
#include "roadstereo/health.hpp"
#include "roadstereo/io/damage_report.hpp"

namespace roadstereo::cli {

/// How well a road was seen in one frame.
struct RoadView {
  DisparityPlane plane;    ///< of the road, px
  double height_m = 0;     ///< of the camera above the road; not finite: unknown
  double noise_px = 0;     ///< of the intact road
  double valid_share = 0;  ///< share of the pixels that have a disparity
};

/// Depth that a frame resolves in the middle of the road that it shows.
struct ResolvedDepth {
  double depth_m = 0;
  double distance_m = 0;  ///< from the camera
};

/// The larger of `min_depth_m` and `threshold_sigma` standard errors of the disparity, in the middle row of the road in
/// the middle column; absent where the height is unknown or nothing is resolved there.
std::optional<ResolvedDepth> resolved_depth(const RoadView& view, const StereoCalibration& calibration,
                                            const DamageOptions& options);

/// Share of a picture of that size below the road's horizon, 0 … 1.
double share_below_horizon(const DisparityPlane& plane, int width, int height);

/// Why depths cannot be trusted: the findings that spoil them.
std::vector<std::string> doubts_of(const std::vector<HealthFinding>& findings);

/// The same of one picture of that size, and whether less than half of what shows the road has a disparity.
std::vector<std::string> doubts_of(const std::vector<HealthFinding>& findings, const RoadView& view, int width,
                                   int height);

/// Limit of a frame without damage in words; without a depth in pixels of disparity; empty without either.
std::string limit_text(const std::optional<ResolvedDepth>& depth, double noise_px, const DamageOptions& options);

}  // namespace roadstereo::cli
