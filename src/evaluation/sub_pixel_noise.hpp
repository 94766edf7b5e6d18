#pragma once

#include <cstdint>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Random error of a matcher, from pairs of shots of one scene that differ in the cameras' noise alone: the difference
/// of both disparity maps has no bias. It is compared with the Cramér–Rao bound of least squares over the window that
/// the map was computed with. That window is measured: errors of pixels that share a part of it are correlated. The sum
/// of the autocorrelation over all distances is the area of a box window, and Σw² of any other with Σw = 1 is 1 over
/// it; no linear smoothing changes the ratio.
class SubPixelNoise {
 public:
  static constexpr int max_distance_px = 32;  ///< beyond it errors are not correlated, in columns and in rows

  /// Adds two maps (pixels, NaN invalid) of one scene; `derivative` is that of the noiseless left image along its rows,
  /// grey levels a pixel, `noise_grey` the standard deviation of the noise of each image, grey levels. Counts the
  /// pixels where the mask is not 0 and the maps differ by at most a pixel, and that are not closer to the border than
  /// `max_distance_px`. Throws Error when the sizes differ.
  void add(ImageView<const float> first, ImageView<const float> second, ImageView<const float> derivative,
           ImageView<const std::uint8_t> mask, double noise_grey);

  double noise_px() const;    ///< standard deviation of the error
  double support_px() const;  ///< side of a square as large as the window
  double bound_px() const;    ///< Cramér–Rao bound of that window: √(2σ² / Σ I_x²), both images being noisy
  double ratio() const;       ///< noise over bound; all are NaN without pixels

 private:
  double pixels_ = 0;
  double squares_ = 0;      ///< of the errors, pixels²
  double products_ = 0;     ///< error times the sum of the errors around it, pixels²
  double information_ = 0;  ///< Fisher information, I_x² / (2σ²), pixels⁻²
};

}  // namespace roadstereo
