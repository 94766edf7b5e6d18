#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// What `read_frame` does with the bytes of a file: PNG, JPEG, TIFF, PGM or PPM. Throws Error that begins with
/// `source`.
Frame decode_frame(const std::string& source, const std::vector<std::uint8_t>& bytes);

}  // namespace roadstereo::io
