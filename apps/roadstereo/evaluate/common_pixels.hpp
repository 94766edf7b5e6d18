#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Where every method gives a disparity, 255, so that what a method leaves out (a margin, occlusions) decides nothing.
/// `maps` has one map per entry of method_names(). BM gives few disparities and has no say.
Image<std::uint8_t> common_pixels(const std::vector<Image<float>>& maps,
                                  const std::optional<ImageView<const std::uint8_t>>& mask);

}  // namespace roadstereo::cli
