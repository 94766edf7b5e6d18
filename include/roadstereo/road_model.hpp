#pragma once

#include <optional>
#include <string>

#include "roadstereo/calibration.hpp"
#include "roadstereo/disparity_plane.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

struct RoadModelOptions {
  bool with_roll = true;              ///< estimate a2; false is the paper's model, eq. (4)
  double max_disparity_share = 0.35;  ///< largest disparity searched, as a share of the image width, 0.05 … 0.9
  double max_road_tilt_deg = 30.0;    ///< steepest sideways tilt of a road; a steeper plane is a wall, 5 … 80
  double min_inlier_share = 0.25;     ///< share of the reliable matches that are inliers of a reliable model, 0 … 1
  double verify_tolerance_px = 1.0;   ///< largest spread of a carried-over model, pixels, above 0, at most 100

  /// Throws Error naming the first option that is out of range.
  void validate() const;
};

/// Road model before matching.
struct RoadModelEstimate {
  DisparityPlane model;
  bool reliable = false;        ///< false: `reason` says why, and matching searches the full range
  bool tracked = false;         ///< the last frame's model, verified on this frame
  std::string reason;           ///< empty when reliable
  int matches = 0;              ///< reliable correspondences found over the whole image
  int inliers = 0;              ///< correspondences on the road
  double residual_px = 0;       ///< robust standard deviation of the inliers around the model, pixels
  double residual_p01_px = 0;   ///< 1st percentile of the residuals of the correspondences near the road, pixels
  double residual_p99_px = 0;   ///< 99th percentile of the same, pixels
  double max_disparity_px = 0;  ///< 99th percentile of all correspondences, for a search without a model
};

/// Estimates the road model from a grey pair: dense coarse-to-fine matching along the rows, then a robust plane.
/// `reliable` is false when the evidence is poor. `calibration`, when given, tells walls from roads by their real tilt.
/// Throws Error when the images seem to be swapped (the matches lie at negative disparities).
RoadModelEstimate estimate_road_model(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                      const std::optional<StereoCalibration>& calibration,
                                      const RoadModelOptions& options, int threads = 0);

/// Verifies `previous`, the last frame's model, on this pair and refines it; `reliable` is false when it does not fit.
RoadModelEstimate verify_road_model(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                    const DisparityPlane& previous, const std::optional<StereoCalibration>& calibration,
                                    const RoadModelOptions& options, int threads = 0);

}  // namespace roadstereo
