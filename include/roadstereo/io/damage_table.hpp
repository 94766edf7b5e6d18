#pragma once

#include <string>

#include "roadstereo/damage.hpp"

namespace roadstereo::io {

// One row per damage, deepest first. Both files have the same columns, named with their units. What is not known is
// empty in CSV and null in JSON: everything metric of an uncalibrated frame, and what is not a finite number.

/// The damages with the frame's noise, and why nothing is metric where that is so.
std::string damages_json(const DamageMap& map);

/// RFC 4180: lines end with CRLF; the line of names is there even when there is no damage.
std::string damages_csv(const DamageMap& map);

}  // namespace roadstereo::io
