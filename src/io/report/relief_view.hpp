#pragma once

#include <string>

#include "roadstereo/damage.hpp"
#include "roadstereo/relief.hpp"

namespace roadstereo::io {

/// Returns the 3-D view of a damage: its surface, quantised to 16 bits, for relief3d.js. `max_depth`: end of the colour
/// scale, in the unit of the relief; `id`: shown number.
std::string relief_html(const Relief& relief, const std::string& id, double max_depth);

}  // namespace roadstereo::io
