#pragma once

#include "roadstereo/image.hpp"
#include "roadstereo/road_model.hpp"

namespace roadstereo {

/// Smoothing of the disparities by their own standard errors. Seen from the road's model the road is flat, and what
/// differs from a neighbour by more than the errors of both is damage and stays.
struct RefinementOptions {
  int radius = 8;                ///< of the neighbours taken in, pixels, 0 … 32; 0 leaves the disparities as they are
  int step = 4;                  ///< distance between them, pixels, 1 … 16
  double truncation_sigmas = 2;  ///< a neighbour this many joint standard errors away has no weight, 0.5 … 100
  double max_agreement_sigma_px =
      0.3;                     ///< a disparity known less well agrees with its neighbours no more easily than this
  double min_sigma_px = 0.02;  ///< standard error that no disparity falls below: interpolation, calibration, 0.001 … 1
  double max_sigma_px = 1.4;   ///< a disparity known less well than that is no measurement: invalid

  void validate() const;
  bool operator==(const RefinementOptions&) const = default;
};

/// Fills `refined` with the mean of each disparity's neighbourhood above the road, weighted by 1 / variance and by
/// agreement with the pixel, and `sigma` with its standard error (pixels). `disparity` and `variance` (pixels²) are
/// those of matching; NaN disparities stay NaN; they and those known too badly have no sigma. `road` is what the
/// disparities are flat against, 0 where no road is known. `support` is the number of pixels that one disparity rests
/// on: neighbours closer than that are not independent. Throws Error when the maps differ in size.
void refine_disparities(ImageView<const float> disparity, ImageView<const float> variance, const DisparityPlane& road,
                        double support, const RefinementOptions& options, int threads, Image<float>& refined,
                        Image<float>& sigma);

}  // namespace roadstereo
