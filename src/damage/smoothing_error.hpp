#pragma once

#include <cmath>
#include <numbers>

namespace roadstereo {

/// Standard errors from the smoothing by the support window of matching: a hollow of the size of the window loses part
/// of its depth. The shares were measured on synthetic roads (docs/damage_accuracy.md). It is the same in every frame.
class SmoothingError {
 public:
  /// As far as matching's block and window reach over a rim, some 10 pixels in `default` (docs/damage.md).
  static constexpr int window_radius_px = 10;

  explicit SmoothingError(double pixels) {
    const double radius_px = std::sqrt(pixels / std::numbers::pi);
    share_ = window_radius_px / radius_px * (1 + window_radius_px / radius_px);
  }
  double max_depth(double value) const { return 0.2 * share_ * value; }
  double mean_depth(double value) const { return 0.5 * share_ * value; }
  double volume(double value) const { return 0.25 * share_ * value; }

 private:
  double share_ = 0;
};

}  // namespace roadstereo
