#pragma once

#include <cmath>

#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// A disparity above the road as it enters a weighted mean.
struct MeasuredHeight {
  float value;      ///< any finite number where there is none
  float precision;  ///< 1 / variance; 0 where there is none
  float variance;   ///< as its neighbours see it: large, but finite, where there is none
};

/// A pixel without a disparity.
ROADSTEREO_HD inline MeasuredHeight not_measured() {
  constexpr float unknown = 1e12F;  // variance of a disparity that is not there
  return {0.0F, 0.0F, unknown};
}

/// Variances between which a disparity can lie, pixels².
struct VarianceBounds {
  float least;  ///< added to every variance
  float most;   ///< agreement with the neighbours counts no larger one
};

/// A disparity (NaN unknown) of the variance given, above the road.
ROADSTEREO_HD inline MeasuredHeight measured(float disparity, float variance, float road,
                                             const VarianceBounds& bounds) {
  constexpr float max_sigma = 10;  // pixels; nothing is known less well than by the search range
  constexpr float widest = max_sigma * max_sigma;
  const MeasuredHeight nothing = not_measured();
  const bool known = disparity == disparity;
  const float bounded = (widest < variance ? widest : variance) + bounds.least;
  const float spread = bounds.most < bounded ? bounds.most : bounded;
  return {known ? disparity - road : nothing.value, known ? 1 / bounded : nothing.precision,
          known ? spread : nothing.variance};
}

/// A refined disparity and its standard error; NaN where it is no measurement.
struct RefinedPixel {
  float disparity;
  float sigma;
};

/// What the mean above the road and its precision make of a pixel.
ROADSTEREO_HD inline RefinedPixel refined_pixel(float disparity, float mean, float precision, float road, float worst,
                                                float nan) {
  /// Variances of the theory are too small by this: the colour weights leave fewer pixels to a cost than its support,
  /// and neither sampling nor the slant of a surface is noise. MeasuredHeight on synthetic roads (docs/accuracy.md).
  constexpr float optimism = 1.7F;
  const float error = sqrtf(optimism / precision);
  const bool known = disparity == disparity && error <= worst;
  return {known ? mean + road : nan, known ? error : nan};
}

}  // namespace roadstereo
