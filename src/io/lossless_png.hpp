#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// Encodes a frame of 8 or 16 bits as PNG with its own samples. `level`: 0 (none) … 9 (smallest); 1 is fast.
std::vector<std::uint8_t> encode_lossless_png(const FrameView& frame, int level);

}  // namespace roadstereo::io
