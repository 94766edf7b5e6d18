#pragma once

#include <string>

#include "roadstereo/cross_section.hpp"
#include "roadstereo/damage.hpp"

namespace roadstereo::io {

/// The cut through a damage as SVG: depth downwards, the undamaged road at 0, what was interpolated dashed.
/// `metric_depth` is that of the map.
std::string profile_svg(const CrossSection& section, const Damage& damage, bool metric_depth);

}  // namespace roadstereo::io
