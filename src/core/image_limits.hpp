#pragma once

namespace roadstereo {

/// Sides of the images that are processed, pixels.
inline constexpr int min_image_side = 32, max_image_side = 8192;

}  // namespace roadstereo
