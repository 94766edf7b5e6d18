#pragma once

#include <cstdint>

#include "damage/box_mask.hpp"

namespace roadstereo {

/// Every cell within `radius` columns and rows of one that is set (grow), or away from one that is not (shrink; the
/// border does not shrink it). Masks are 0 or 255.
Image<std::uint8_t> grow(const Image<std::uint8_t>& mask, int radius);
Image<std::uint8_t> shrink_mask(const Image<std::uint8_t>& mask, int radius);

/// The same of what lies in `box`; outside it the result is 0.
BoxMask grow(const BoxMask& mask, int radius, const Box& box);
BoxMask shrink_mask(const BoxMask& mask, int radius, const Box& box);

}  // namespace roadstereo
