#pragma once

#include <cstdint>
#include <string>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Reads a mask from an image: 255 where any colour of the pixel is at least `least`, 0 elsewhere.
Image<std::uint8_t> read_mask(const std::string& path, int least = 1);

}  // namespace roadstereo::cli
