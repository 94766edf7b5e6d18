#pragma once

#include "roadstereo/image.hpp"
#include "roadstereo/road_model.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Options of the refinement: a mean over the neighbours, weighted by the inverse of their variances and by their
/// agreement with the pixel. It averages heights above the road model, in which the road is flat. In the first pass the
/// heights are compared along the local slope of the surface, as far as that exceeds the noise. Differences beyond the
/// joint errors are kept. Each further pass averages the result of the last one over a window twice as large (à-trous
/// filter, guided by the variance).
struct RefinementOptions {
  int passes = 2;                       ///< 1 … 3
  int radius = 12;                      ///< of the first window, pixels, 0 … 32; 0 switches the refinement off
  int step = 6;                         ///< distance between its neighbours, pixels, 1 … 16
  double truncation_sigmas = 2.75;      ///< difference with weight 0, joint standard errors, 0.5 … 100
  double max_agreement_sigma_px = 0.6;  ///< upper bound on σ in that test, pixels, min_sigma_px … 10
  double min_sigma_px = 0.02;           ///< standard error of interpolation and calibration, pixels, 0.001 … 1
  double max_sigma_px = 1.0;            ///< disparities with a larger σ become invalid, pixels, above 0
  int smoothing_px = 6;  ///< standard deviation of all averaging, pixels, 0 … 32; determines what σ gains on a bent
                         ///< surface; 0: nothing

  /// Throws Error naming the first option that is out of range.
  void validate() const;
  bool operator==(const RefinementOptions&) const = default;
};

/// Writes the refined disparities (pixels) and their standard errors `sigma` (pixels); both are NaN where the disparity
/// is NaN or its error, without that of smoothing, exceeds max_sigma_px. `disparity` (pixels, NaN invalid) and
/// `variance` (pixels²) are from matching with this `pixel_step`, 1 or 2. `road`: road model, 0 where unknown.
/// `effective_samples`: number of pixels from which one disparity is computed; neighbours closer than that are not
/// independent. Throws Error when the maps differ in size.
void refine_disparities(ImageView<const float> disparity, ImageView<const float> variance, int pixel_step,
                        const DisparityPlane& road, double effective_samples, const RefinementOptions& options,
                        int threads, Image<float>& refined, Image<float>& sigma);

/// Fills the pixels between those that were matched with a `pixel_step` of 2: writes W×H maps from those of every
/// second row and column. Heights above the road model are interpolated linearly; where two neighbours differ by more
/// than a pixel there is an edge, and the one with the smaller error is taken, as where only one is known.
/// Throws Error when the maps do not have (W + 1)/2 × (H + 1)/2 pixels.
void interpolate_disparities(ImageView<const float> disparity, ImageView<const float> sigma, const DisparityPlane& road,
                             int width, int height, int threads, Image<float>& full, Image<float>& full_sigma);

}  // namespace roadstereo
#pragma GCC visibility pop
