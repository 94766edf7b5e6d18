#pragma once

#include <cmath>

#include "roadstereo/disparity_plane.hpp"
#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// Error of disparities on slopes: a window's mean belongs to some place near its middle, σ_place pixels away, so that
/// a slope of the height above the road adds σ_place²·slope² to the variance. C++17, for kernels.
struct SlopeError {
  static constexpr int reach = 2;  ///< distance of the two neighbours between which a slope is taken, pixels

  float road_across;  ///< change of the road's disparity between the two of a row, pixels
  float road_down;    ///< of a column
  float scale;        ///< (σ_place / 2·reach)²

  SlopeError(const DisparityPlane& road, double place_sigma_px)
      : road_across(static_cast<float>(2 * reach * road.a2)),
        road_down(static_cast<float>(2 * reach * road.a1)),
        scale(static_cast<float>(place_sigma_px * place_sigma_px / (4.0 * reach * reach))) {}

  /// Standard error `sigma` with this one. Disparities to the left, right, above and below; NaN unknown.
  ROADSTEREO_HD float added_to(float sigma, float left, float right, float above, float below) const {
    const float across = right - left - road_across, down = below - above - road_down;
    const float squared = (across == across ? across * across : 0.0F) + (down == down ? down * down : 0.0F);
    return sqrtf(sigma * sigma + scale * squared);
  }
};

}  // namespace roadstereo
