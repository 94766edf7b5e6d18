#pragma once

#include <cstdint>

#include "roadstereo/image_view.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// How much more the right image of a pair is blurred than the left one: difference of the variances of two Gaussian
/// point-spread functions.
struct BlurDifference {
  double variance_px2 = 0;  ///< σ² of the right image less σ² of the left one, pixels²
  double stderr_px2 = 0;    ///< standard error of `variance_px2`, pixels²
  int windows = 0;          ///< windows of either image whose spectra were compared; 0: the difference is unknown

  static constexpr double max_px2 = 16;  ///< a larger difference is reduced to this

  bool known() const { return windows > 0; }
};

/// Measures the difference of the blur from the power spectra of windows of 64×64 pixels, less white noise: at the
/// frequency ω a Gaussian leaves exp(−σ²ω²) of the power, so that the logarithm of the ratio of the two spectra is a
/// line in ω². Windows with a line of constant grey, such as in a border or a white sky, and those with pixels of the
/// left image where `mask` (W×H, or empty) is not 0 are left out. Unknown with fewer than 16 windows, or where noise
/// hides the texture. Throws Error when the sizes differ.
BlurDifference measure_blur_difference(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                       int threads = 0, ImageView<const std::uint8_t> mask = {});

}  // namespace roadstereo
#pragma GCC visibility pop
