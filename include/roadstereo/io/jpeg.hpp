#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Encodes an 8-bit frame as JPEG, `quality` 1 … 100. A frame wider than `max_width` pixels is downsampled to that
/// width. Throws Error for 16-bit samples, SystemError on failure.
std::vector<std::uint8_t> encode_jpeg(const FrameView& frame, int quality, int max_width);

}  // namespace roadstereo::io
#pragma GCC visibility pop
