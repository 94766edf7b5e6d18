#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Mask of the pixels where every method has a disparity, 255 inside, so that missing disparities (margins, occlusions)
/// do not affect a comparison. `maps` has one map per entry of method_names(), then the given maps. BM is ignored,
/// since it is too sparse.
Image<std::uint8_t> common_pixels(const std::vector<Image<float>>& maps,
                                  const std::optional<ImageView<const std::uint8_t>>& mask);

}  // namespace roadstereo::cli
