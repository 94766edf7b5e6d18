#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// Encodes damage ids as 16-bit grey PNG, values unchanged.
std::vector<std::uint8_t> encode_label_png(ImageView<const std::uint16_t> labels);

}  // namespace roadstereo::io
