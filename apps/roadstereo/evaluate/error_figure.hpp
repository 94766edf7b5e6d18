#pragma once

#include <cstdint>
#include <optional>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// The absolute error in colours up to `reach_px`, and the histogram of the signed error between ± that.
Frame error_figure(ImageView<const float> map, ImageView<const float> truth,
                   const std::optional<ImageView<const std::uint8_t>>& mask, double reach_px);

}  // namespace roadstereo::cli
