#pragma once

#include <cmath>

#include "stereo/coarse/pixel_height.hpp"

namespace roadstereo {

// The road as prior of the coarse search. C++17, for kernels.

/// Prior of a pixel: disparity d costs weight · min(|d − road|, truncation)² more, coarse pixels.
struct DistanceCost {
  float weight = 0, truncation = 0;
};

/// What a height above or below the road costs: the negative logarithm of a normal distribution, truncated for what is
/// not the road. Heights are metres, since damage is.
class HeightPrior {
 public:
  /// `height_m` costs 1, and nothing more than `truncation`; 0: no prior. `factor`: size of a coarse pixel.
  HeightPrior(double height_m, double truncation, const PerspectiveShift& shift, int factor)
      : pixel_(shift, height_m > 0 ? height_m : 1, factor),
        root_of_truncation_(static_cast<float>(std::sqrt(truncation))),
        used_(height_m > 0) {}

  /// Of a pixel where the road has `disparity`, full-size pixels, and a block with that texture uncertainty.
  ROADSTEREO_HD DistanceCost at(float disparity, float texture_uncertainty) const {
    if (!used_) return {};
    const float pixel = pixel_.at(disparity);
    return {texture_uncertainty * pixel * pixel, root_of_truncation_ / pixel};
  }

 private:
  PixelHeight pixel_;
  float root_of_truncation_;
  bool used_;
};

}  // namespace roadstereo
