#pragma once

#include <string>

#include "roadstereo/cross_section.hpp"
#include "roadstereo/damage.hpp"

namespace roadstereo::io {

/// Draws a cross-section of a damage as SVG: depth downwards, the undamaged road at 0, interpolated parts dashed. `id`
/// is its shown number. `metric_depth`: depths are in metres.
std::string profile_svg(const CrossSection& section, const Damage& damage, const std::string& id, bool metric_depth);

}  // namespace roadstereo::io
