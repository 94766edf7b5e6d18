#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// Encodes a thumbnail of the left image with the outlines of its damages as JPEG, at most `width` pixels wide.
std::vector<std::uint8_t> frame_thumbnail(const FrameView& left, const DamageMap& map, int width = 220);

/// Encodes the surroundings of one damage in the left image with its outline as JPEG, at most `side`×`side` pixels.
std::vector<std::uint8_t> damage_picture(const FrameView& left, const DamageMap& map, const Damage& damage,
                                         int side = 260);

}  // namespace roadstereo::io
