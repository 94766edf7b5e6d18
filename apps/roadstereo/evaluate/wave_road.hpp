#pragma once

#include <cstdint>

#include "pair_source.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Pair of a road whose grey levels are a sum of plane waves, with equal power in each octave of the wavelength: both
/// images, the disparities and the derivative of the left image are exact, in closed form. The road is a roof with its
/// ridge along the middle column, flat to either side of it, so that the disparities relative to any plane close to it
/// pass through all sub-pixel phases, without curvature that a window would smooth.
class WaveRoad {
 public:
  static constexpr int width = 640, height = 360;
  static constexpr double contrast_grey = 20;  ///< standard deviation of the grey levels

  WaveRoad(std::uint64_t seed, int threads);

  /// Takes a picture with both cameras, with white noise of this standard deviation, grey levels, rounded to 8 bits.
  StereoPair shot(double noise_grey, std::uint64_t noise_seed) const;

  const Image<float>& truth() const { return truth_; }            ///< disparity, pixels
  const Image<float>& derivative() const { return derivative_; }  ///< of the left image, grey levels a pixel
  const Image<std::uint8_t>& inside() const { return inside_; }   ///< 255 away from the ridge and the border

 private:
  Image<float> left_, right_;  ///< grey levels
  Image<float> truth_, derivative_;
  Image<std::uint8_t> inside_;
};

}  // namespace roadstereo::cli
