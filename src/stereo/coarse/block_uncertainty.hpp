#pragma once

#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// Gradient of a pixel, in quarters of a grey level over two pixels, so that sums of squares stay exact in 32 bits.
struct CoarseGradient {
  static constexpr int shift = 2;
  int across, down;
};

ROADSTEREO_HD inline CoarseGradient coarse_gradient(int left, int right, int above, int below) {
  return {(right - left) >> CoarseGradient::shift, (below - above) >> CoarseGradient::shift};
}

/// Squared standard errors, in units of the gradient and of pixels.
struct UncertaintyParams {
  float noise2;      ///< of a pixel
  float row_error2;  ///< of the rows' offset
  float half2;       ///< of the disparity at uncertainty ½
};

/// Texture uncertainty of a block, 0 … 1, from Σ gu² and Σ gu gv over it
/// (stereo/coarse/texture_uncertainty.hpp).
ROADSTEREO_HD inline float texture_uncertainty(int squares, int products, const UncertaintyParams& terms) {
  const float sum = static_cast<float>(squares), known = sum > 1.0F ? sum : 1.0F;
  const float tilt = static_cast<float>(products) / known;
  const float variance = terms.noise2 / known + terms.row_error2 * tilt * tilt;
  return variance / (variance + terms.half2);
}

}  // namespace roadstereo
