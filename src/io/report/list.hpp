#pragma once

#include <string>

#include "roadstereo/damage.hpp"

namespace roadstereo::io {

/// The table of all damages, whose columns can be sorted. Empty without damage.
std::string damage_list(const DamageMap& map);

}  // namespace roadstereo::io
