#pragma once

#include <cstdint>
#include <string>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// Read a mask from an image: 255 where any colour channel of the pixel is at least `threshold`, 0 elsewhere. Alpha is
/// ignored.
Image<std::uint8_t> read_mask(const std::string& path, int threshold = 1);

}  // namespace roadstereo::cli
