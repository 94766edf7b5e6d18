#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "roadstereo/lens_spots.hpp"
#include "roadstereo/pipeline.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Something out of order with a rig.
struct HealthFinding {
  std::string id;    ///< code, as of a warning: "row-error", "distortion", …
  double value = 0;  ///< measured
  double limit = 0;  ///< in the same unit
  std::string unit;
  std::string text;           ///< one sentence: what is measured, the limit, what to do
  bool spoils_depth = false;  ///< depths cannot be trusted: no damage is graded
};

/// State of a rig as one pair shows it. NaN: unknown.
struct PairHealth {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  // Vertical offsets v_right − v_left, by affine Lucas-Kanade alignment of blocks.
  double row_offset_px = unknown;     ///< at the principal point
  double row_correction_px = 0;       ///< of it, undone before matching
  double row_scale = unknown;         ///< relative size of the right view minus 1
  double row_turn_rad = unknown;      ///< of the right view about the optical axis
  double row_error_px = unknown;      ///< vertical offset not undone, 90th percentile of the points
  double distortion_right = unknown;  ///< k of 1 + k r² left in the right view alone
  double distortion_both = unknown;   ///< k of 1 + k r² left in both views
  double bowl_px = unknown;  ///< largest disparity error on the road that the distortion causes and a quadratic road
                             ///< surface cannot absorb

  // The road's residual.
  double noise_px = unknown;  ///< standard deviation of the intact road
  double wave_px = unknown;   ///< robust one of the medians of its rows: vibration of one view, or undulation

  // Grey levels on the road.
  double gain = unknown;           ///< right by left
  double clipped_left = unknown;   ///< share of the pixels that are black or white, 0 … 1
  double clipped_right = unknown;  ///< the same
  double blur_left_px = unknown;   ///< standard deviation of a Gaussian blur
  double blur_right_px = unknown;
  double noise_share = unknown;  ///< of the variance of blocks of 7×7 pixels: white noise that the views do not share
  double blocks_left = unknown;  ///< excess of the steps between 8×8 blocks (JPEG) over other steps, relative
  double blocks_right = unknown;

  double infinity_px = unknown;  ///< smallest disparity + doffs above the horizon (10th percentile)

  PairSpots spots;  ///< of a recording, by PairWatch

  double threshold_sigma = 5;  ///< of DamageOptions

  /// What exceeds its limit.
  std::vector<HealthFinding> findings() const;
  /// Whether no finding spoils the depth.
  bool depth_is_trusted() const;
};

/// Measure the health of a pair. `damage`: of the frame, by find_damage. Throws Error when it has another size.
PairHealth measure_health(const FrameResult& frame, const DamageMap& damage,
                          const std::optional<StereoCalibration>& calibration, const DamageOptions& options = {},
                          int threads = 0);

/// Set the severity of every damage to `unknown` if the depth cannot be trusted.
void withhold_severity(const PairHealth& health, DamageMap& damage);

}  // namespace roadstereo
#pragma GCC visibility pop
