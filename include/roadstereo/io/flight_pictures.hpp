#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// The left image, small, with the outlines of its damages, as JPEG; `width` pixels wide or narrower.
std::vector<std::uint8_t> frame_thumbnail(const FrameView& left, const DamageMap& map, int width = 220);

/// What surrounds one damage in the left image, with its outline, as JPEG; no side longer than `side` pixels.
std::vector<std::uint8_t> damage_picture(const FrameView& left, const DamageMap& map, const Damage& damage,
                                         int side = 260);

}  // namespace roadstereo::io
