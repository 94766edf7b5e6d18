#pragma once

#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// The 8-bit frame as it comes back from a JPEG of that quality, 1 … 100. Throws Error for another quality or depth.
Frame with_jpeg_loss(const Frame& frame, int quality);

}  // namespace roadstereo::io
