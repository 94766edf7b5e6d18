#pragma once

#include <cmath>

#include "roadstereo/perspective_shift.hpp"

namespace roadstereo {

// The road as prior of the coarse search. C++17, for kernels.

/// Prior of a pixel: disparity d costs weight · min(|d − road|, truncation)² more, coarse pixels.
struct DistanceCost {
  float weight = 0, truncation = 0;
};

/// What a height above or below the road costs: the negative logarithm of a normal distribution, truncated for what is
/// not the road. Heights are metres, since damage is: a pixel of disparity is millimetres below a hand and decimetres
/// ahead of a car.
class HeightPrior {
 public:
  /// `height_m` costs 1, and nothing more than `truncation`; 0: no prior. `factor`: size of a coarse pixel.
  HeightPrior(double height_m, double truncation, const PerspectiveShift& shift, int factor)
      : offset_px_(static_cast<float>(shift.disparity_offset_px)),
        root_of_truncation_(static_cast<float>(std::sqrt(truncation))) {
    constexpr double max_pixel_m = 1;  // a pixel beyond is more than any damage
    if (height_m == 0) return;
    scale_ = static_cast<float>(factor * shift.camera_height_m / height_m);
    max_pixel_ = static_cast<float>(max_pixel_m / height_m);
  }

  /// Of a pixel where the road has `disparity`, full-size pixels, and a block with that texture uncertainty.
  ROADSTEREO_HD DistanceCost at(float disparity, float texture_uncertainty) const {
    if (scale_ == 0.0F) return {};
    const float height = scale_ / (disparity + offset_px_);  // of a coarse pixel, in units of the prior's
    const float pixel = height > 0.0F && height < max_pixel_ ? height : max_pixel_;
    return {texture_uncertainty * pixel * pixel, root_of_truncation_ / pixel};
  }

 private:
  float scale_ = 0, max_pixel_ = 0, offset_px_, root_of_truncation_;
};

}  // namespace roadstereo
