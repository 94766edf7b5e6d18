#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/damage.hpp"
#include "roadstereo/image.hpp"
#include "roadstereo/io/damage_report.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Encodes a thumbnail of the left image with the outlines of its damages as JPEG, at most `width` pixels wide.
/// `white_level` as in to_grey.
std::vector<std::uint8_t> frame_thumbnail(const FrameView& left, double white_level, const DamageMap& map,
                                          int width = 220);

/// Encodes the surroundings of one damage in the left image with its outline as JPEG, at most `side`×`side` pixels.
/// `white_level` as in to_grey.
std::vector<std::uint8_t> damage_picture(const FrameView& left, double white_level, const DamageMap& map,
                                         const Damage& damage, int side = 260);

/// Returns the section of one damage for `flight_report`: values, image, depths, cross-section and 3-D view. `id`: of
/// the road damage. Throws Error if the sizes of the maps differ.
std::string road_damage_section(const DamageReportInput& input, const Damage& damage, std::int64_t id);

}  // namespace roadstereo::io
#pragma GCC visibility pop
