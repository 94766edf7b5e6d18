#pragma once

#include <string>

#include "roadstereo/damage.hpp"

namespace roadstereo::io {

/// Returns the sortable table of all damages; empty without damage.
std::string damage_list(const DamageMap& map);

/// Returns the table of the candidates; empty without any.
std::string candidate_list(const DamageMap& map);

}  // namespace roadstereo::io
