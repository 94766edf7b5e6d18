#pragma once

#include <cstdint>

#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// The frame in 8-bit colour with a veil of magenta where the mask is not 0. `white_level` as in to_grey. Throws Error
/// when the sizes differ.
Frame tint_magenta(const FrameView& frame, double white_level, ImageView<const std::uint8_t> mask);

}  // namespace roadstereo::io
