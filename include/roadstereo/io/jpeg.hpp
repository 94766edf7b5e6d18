#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// Encodes an 8-bit frame as JPEG of that quality, 1 … 100; a frame wider than `max_width` pixels is shrunk to it.
std::vector<std::uint8_t> encode_jpeg(const FrameView& frame, int quality, int max_width);

}  // namespace roadstereo::io
