#pragma once

#include <string>

#include "roadstereo/damage.hpp"
#include "roadstereo/relief.hpp"

namespace roadstereo::io {

/// The 3-D view of a damage: its surface in steps of 16 bits for relief3d.js to draw. `reach` is the depth of the last
/// colour, in the unit of the relief's depths.
std::string relief_html(const Relief& relief, const Damage& damage, double reach);

}  // namespace roadstereo::io
