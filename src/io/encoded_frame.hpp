#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// Decodes PNG, JPEG, TIFF, PGM or PPM, see `read_frame`. Throws Error; the message starts with `source`.
Frame decode_frame(const std::string& source, const std::vector<std::uint8_t>& bytes);

}  // namespace roadstereo::io
