#pragma once

#include <cmath>

#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// Smoothing bias: standard error `sigma` of a disparity with that of the mean over a bent surface. Averaging with the
/// standard deviation s shifts it by ½s²·∂²d/∂u², half the second difference over s pixels, and the same down the
/// column. `two_across` and `two_down`: sums of the disparities s pixels away on either side, NaN unknown. C++17, for
/// kernels.
ROADSTEREO_HD inline float with_smoothing_bias(float sigma, float disparity, float two_across, float two_down) {
  const float across = 0.5F * two_across - disparity, down = 0.5F * two_down - disparity;
  return sqrtf(sigma * sigma + (across == across ? across * across : 0.0F) + (down == down ? down * down : 0.0F));
}

}  // namespace roadstereo
