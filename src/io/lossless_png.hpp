#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Encodes an 8- or 16-bit frame as PNG, samples unchanged. `level`: compression, 0 (none) … 9 (smallest); 1 is fast.
std::vector<std::uint8_t> encode_lossless_png(const FrameView& frame, int level);

}  // namespace roadstereo::io
#pragma GCC visibility pop
