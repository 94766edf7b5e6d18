#pragma once

#include <cstdint>
#include <optional>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// |map − truth| where both are known and the mask is not 0, NaN elsewhere.
Image<float> absolute_error(ImageView<const float> map, ImageView<const float> truth,
                            const std::optional<ImageView<const std::uint8_t>>& mask);

/// Sparse maps (lidar) for the eye: every point becomes a square that reaches `radius` pixels further; the largest
/// value wins.
Image<float> thicken(ImageView<const float> map, int radius);

}  // namespace roadstereo::cli
