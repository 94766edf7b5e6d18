#pragma once

#include <cstdint>

#include "roadstereo/image.hpp"

namespace roadstereo::cli {

/// The frame in 8-bit grey, as `DamageInput` takes it.
Image<std::uint8_t> grey_of(const Frame& frame);

}  // namespace roadstereo::cli
