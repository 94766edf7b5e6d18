#pragma once

#include <cmath>

#include "roadstereo/host_device.hpp"

// Left-right check, eq. (12), and sub-pixel disparity of a winner, for the host and for kernels. C++17.

namespace roadstereo {

struct FinishSettings {
  bool left_right_check;
  float lr_max_diff_px;
  float occlusion_variance;  ///< added to what fails the check, pixels²; 0 makes it invalid
  bool sub_pixel;
  bool reject_range_boundary;  ///< winners without two neighbours are invalid
};

/// Returns the disparity of a winner (−1: none), NaN where it is invalid; adds to `variance` where the check fails. The
/// shift of the perspective transformation depends on the target pixel alone, so that it cancels in the check.
/// `target_winner` is the winner of the target pixel that it meets (−1: none, which fails the check), `offset` its
/// sub-pixel offset, NaN without two neighbours.
ROADSTEREO_HD inline float finish_disparity(int winner, int target_winner, float offset, const FinishSettings& settings,
                                            float& variance) {
  if (winner < 0) return NAN;
  const float difference = fabsf(static_cast<float>(winner - target_winner));
  if (settings.left_right_check && (target_winner < 0 || difference > settings.lr_max_diff_px)) {
    if (settings.occlusion_variance == 0) return NAN;
    variance += settings.occlusion_variance;
  }
  const bool bracketed = offset == offset;
  if (!bracketed && settings.reject_range_boundary) return NAN;
  return static_cast<float>(winner) + (bracketed && settings.sub_pixel ? offset : 0.0F);
}

}  // namespace roadstereo
