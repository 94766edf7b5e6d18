#pragma once

#include <cstdint>
#include <string>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Reads a mask from an image: 255 where any sample of the pixel is above zero, 0 elsewhere.
Image<std::uint8_t> read_mask(const std::string& path);

}  // namespace roadstereo::cli
