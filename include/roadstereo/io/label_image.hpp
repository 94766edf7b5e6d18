#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Encodes damage ids as 16-bit grey PNG, values unchanged.
std::vector<std::uint8_t> encode_label_png(ImageView<const std::uint16_t> labels);

}  // namespace roadstereo::io
#pragma GCC visibility pop
