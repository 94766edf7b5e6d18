#pragma once

#include <string>

#include "roadstereo/damage.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

// One row per damage, deepest first. Both files have the same columns, named with their units. Unknown values are empty
// in CSV and null in JSON: all metric values of an uncalibrated frame, and all values that are not finite.

/// Returns the damages, the noise of the frame, and the reason if no values are metric.
std::string damages_json(const DamageMap& map);

/// Returns RFC 4180 CSV: lines end with CRLF; the header line is always present.
std::string damages_csv(const DamageMap& map);

}  // namespace roadstereo::io
#pragma GCC visibility pop
