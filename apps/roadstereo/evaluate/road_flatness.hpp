#pragma once

#include <cstdint>

#include "roadstereo/image.hpp"
#include "roadstereo/road_model.hpp"

namespace roadstereo::cli {

/// The projection model of a road without roll, d = α0 + α1·v: the line of the v-disparity histogram, by least squares
/// over the valid disparities of the mask (eq. alpha2). Throws Error when they do not fill two rows.
RoadModel fit_without_roll(ImageView<const float> disparity, ImageView<const std::uint8_t> mask);

/// σ_d of the disparities of the mask, transformed with `plane` (eq. sigma_d). NaN when there are none.
double transformed_deviation(ImageView<const float> disparity, ImageView<const std::uint8_t> mask,
                             const RoadModel& plane);

}  // namespace roadstereo::cli
