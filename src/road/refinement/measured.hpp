#pragma once

#include <cmath>

#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// Height of a disparity above the road, for the weighted mean.
struct MeasuredHeight {
  float value;      ///< any finite number where unknown
  float precision;  ///< 1 / variance; 0 where unknown
  float variance;   ///< bounded variance of the agreement test; large, but finite, where unknown
};

/// A pixel without a disparity.
ROADSTEREO_HD inline MeasuredHeight not_measured() {
  constexpr float unknown = 1e12F;  // variance of a disparity that is not there
  return {0.0F, 0.0F, unknown};
}

/// Bounds of the variance of a disparity, pixels².
struct VarianceBounds {
  float min;  ///< added to every variance
  float max;  ///< upper bound in the agreement test
};

/// Height above the road of a disparity (NaN unknown) with the given variance.
ROADSTEREO_HD inline MeasuredHeight measured(float disparity, float variance, float road,
                                             const VarianceBounds& bounds) {
  constexpr float max_sigma = 10;  // pixels
  constexpr float widest = max_sigma * max_sigma;
  const MeasuredHeight unknown = not_measured();
  const bool known = disparity == disparity;
  const float bounded = (widest < variance ? widest : variance) + bounds.min;
  const float spread = bounds.max < bounded ? bounds.max : bounded;
  return {known ? disparity - road : unknown.value, known ? 1 / bounded : unknown.precision,
          known ? spread : unknown.variance};
}

/// A refined disparity and its standard error, both NaN where it is no measurement; between passes its variance,
/// pixels².
struct RefinedPixel {
  float disparity;
  float error;
};

/// Refined disparity from the mean height above the road and its precision.
ROADSTEREO_HD inline RefinedPixel refined_pixel(float disparity, float mean, float precision, float road, bool is_last,
                                                float worst, float nan) {
  if (!is_last) return {disparity == disparity ? mean + road : nan, 1 / precision};
  const float error = 1 / sqrtf(precision);
  const bool known = disparity == disparity && error <= worst;
  return {known ? mean + road : nan, known ? error : nan};
}

}  // namespace roadstereo
