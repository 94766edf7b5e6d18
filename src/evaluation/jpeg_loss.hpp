#pragma once

#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// Encodes an 8-bit frame as JPEG, `quality` 1 … 100, and decodes it. Throws Error for another quality or depth.
Frame with_jpeg_loss(const Frame& frame, int quality);

}  // namespace roadstereo::io
