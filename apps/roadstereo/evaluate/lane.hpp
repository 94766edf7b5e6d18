// Parts of a road: the lane in front of a car, and edges along the rows.
#pragma once

#include <cstdint>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::cli {

inline constexpr double lane_half_width_m = 1.75;
inline constexpr double lane_length_m = 15;

/// Mask of the road pixels, 255, whose true point lies within lane_half_width_m to either side of the left camera and
/// nearer than lane_length_m. `truth` in pixels, NaN unknown; `road` not 0 on the road.
Image<std::uint8_t> lane_mask(ImageView<const float> truth, ImageView<const std::uint8_t> road,
                              const StereoCalibration& calibration);

/// Mask of the pixels, 255, whose block of 11×11 pixels has at least four times the gradient (root mean square) down
/// than across: a match may slide along such an edge.
Image<std::uint8_t> edges_along_rows(const GreyImage& grey);

/// Sets the pixels of `mask` to 0 where `excluded` is not 0.
void exclude(ImageView<const std::uint8_t> excluded, Image<std::uint8_t>& mask);

}  // namespace roadstereo::cli
