#pragma once

#include <cmath>

#include "core/full_resolution.hpp"
#include "roadstereo/perspective_shift.hpp"

namespace roadstereo {

/// The road in a row of the downsampled pair. C++17, for kernels: double precision, slow on small GPUs, once a row.
class CoarseRoad {
 public:
  ROADSTEREO_HD CoarseRoad(const PerspectiveShift& shift, int v, int factor)
      : delta_p_(static_cast<float>(shift.delta_p)), factor_(static_cast<float>(factor)) {
    if (!shift.enabled) return;
    first_ = static_cast<float>(shift.road.disparity(to_full_resolution(0, factor), to_full_resolution(v, factor)));
    step_ = static_cast<float>(shift.road.a2 * factor);
  }

  /// Disparity at a column, full-size pixels; negative above the horizon and without a road.
  ROADSTEREO_HD float disparity(int u) const { return first_ + static_cast<float>(u) * step_; }
  /// What the shift leaves of a disparity, coarse pixels; NaN above the horizon and without a road.
  ROADSTEREO_HD float shifted(float disparity) const {
    return disparity < 0.0F ? NAN : (disparity < delta_p_ ? disparity : delta_p_) / factor_;
  }

 private:
  float first_ = -1, step_ = 0, delta_p_, factor_;
};

}  // namespace roadstereo
