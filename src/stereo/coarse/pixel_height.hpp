#pragma once

#include "roadstereo/perspective_shift.hpp"

namespace roadstereo {

/// Height above or below the road that a change of the disparity by one pixel means: millimetres below a hand,
/// decimetres ahead of a car. C++17, for kernels.
class PixelHeight {
 public:
  /// Of a pixel as large as `size` of the full size, in units of `unit_m` metres, above 0.
  PixelHeight(const PerspectiveShift& shift, double unit_m, int size)
      : scale_(static_cast<float>(size * shift.camera_height_m / unit_m)),
        max_(static_cast<float>(max_height_m / unit_m)),
        offset_px_(static_cast<float>(shift.disparity_offset_px)) {}

  /// Where the road has `disparity`, full-size pixels; above the horizon and without a road the largest.
  ROADSTEREO_HD float at(float disparity) const {
    const float height = scale_ / (disparity + offset_px_);
    return height > 0.0F && height < max_ ? height : max_;
  }

 private:
  static constexpr double max_height_m = 1;  // a pixel beyond is more than any damage

  float scale_, max_, offset_px_;
};

}  // namespace roadstereo
