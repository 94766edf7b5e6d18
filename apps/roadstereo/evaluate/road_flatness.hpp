#pragma once

#include <cstdint>

#include "roadstereo/image.hpp"
#include "roadstereo/road_model.hpp"

namespace roadstereo::cli {

/// Fit the projection model of a road without roll, d = α0 + α1·v, the line of the v-disparity histogram, by least
/// squares to the valid disparities of the mask (eq. (16), alpha2). Throws Error when they lie in fewer than two rows.
DisparityPlane fit_without_roll(ImageView<const float> disparity, ImageView<const std::uint8_t> mask);

/// σ_d: standard deviation of the disparities of the mask after transformation with `plane`, pixels (eq. (37),
/// sigma_d). NaN if there are none.
double transformed_deviation(ImageView<const float> disparity, ImageView<const std::uint8_t> mask,
                             const DisparityPlane& plane);

}  // namespace roadstereo::cli
