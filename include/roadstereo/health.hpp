#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/lens_spots.hpp"
#include "roadstereo/pipeline.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// A measured quantity of a rig that exceeds its limit.
struct HealthFinding {
  std::string id;    ///< code, as of a warning: "row-error", "distortion", …
  double value = 0;  ///< measured
  double limit = 0;  ///< in the same unit
  std::string unit;
  std::string text;           ///< one sentence: what is measured, the limit, what to do
  bool spoils_depth = false;  ///< depths cannot be trusted: no damage is graded
};

/// State of a rig, measured from one pair. NaN: unknown.
struct PairHealth {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  // Vertical offsets v_right − v_left, by affine Lucas-Kanade alignment of blocks.
  double row_offset_px = unknown;     ///< at the principal point
  double row_correction_px = 0;       ///< part of that offset that was corrected before matching
  double row_scale = unknown;         ///< relative size of the right view minus 1
  double row_turn_rad = unknown;      ///< of the right view about the optical axis
  double row_error_px = unknown;      ///< vertical offset not undone, 90th percentile of the points
  double row_scatter_px = unknown;    ///< robust standard deviation of the points around all that a rigid rig shows;
                                      ///< above 1 px unknown where neighbours contradict each other, too
  double distortion_right = unknown;  ///< k of 1 + k r² left in the right view alone
  double distortion_both = unknown;   ///< k of 1 + k r² left in both views
  double bowl_px = unknown;  ///< largest disparity error on the road that the distortion causes and a quadratic road
                             ///< surface cannot absorb

  // The road's residual.
  double noise_px = unknown;  ///< standard deviation of the intact road
  double wave_px = unknown;   ///< robust standard deviation of the medians of the road's rows: vibration of one view,
                              ///< or undulation

  // Grey levels on the road.
  double gain = unknown;           ///< ratio of right to left
  double clipped_left = unknown;   ///< share of the pixels that are black or white, 0 … 1
  double clipped_right = unknown;  ///< the same
  double blur_left_px = unknown;   ///< standard deviation of a Gaussian blur
  double blur_right_px = unknown;
  double noise_share = unknown;   ///< share of white noise, which the views do not have in common, in the variance of
                                  ///< blocks of 7×7 pixels
  double stripe_share = unknown;  ///< share of the noise of whole columns and rows in it
  double blocks_left = unknown;   ///< excess of the steps between 8×8 blocks (JPEG) over other steps, relative
  double blocks_right = unknown;

  double infinity_px = unknown;  ///< smallest disparity + doffs above the horizon (10th percentile)

  PairSpots spots;  ///< set only for recordings, from PairWatch

  double threshold_sigma = 5;  ///< of DamageOptions

  /// Returns a finding for every value that exceeds its limit.
  std::vector<HealthFinding> findings() const;
  /// Whether none of the findings has `spoils_depth`.
  bool depth_is_trusted() const;
};

/// Measure the health of a pair. `damage`: result of find_damage for the frame. All values are unknown without a road
/// (`FrameResult::roll_found`) or without grey images. Throws Error when `damage` has another size.
PairHealth measure_health(const FrameResult& frame, const DamageMap& damage,
                          const std::optional<StereoCalibration>& calibration, const DamageOptions& options = {},
                          int threads = 0);

/// If the depth cannot be trusted, set the severity of every damage and candidate to `unknown`, and its probabilities
/// to 0.
void withhold_severity(const PairHealth& health, DamageMap& damage);

}  // namespace roadstereo
#pragma GCC visibility pop
