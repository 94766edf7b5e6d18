#pragma once

#include <string>

#include "roadstereo/damage.hpp"

namespace roadstereo::io {

// Figures as a report shows them: rounded to what is known.

/// A value with three significant digits.
std::string value_text(double value, const std::string& unit);

/// "45.2 ± 1.3 mm": the error with two digits when it begins with 1 or 2, else with one, and the value with as many
/// decimals. Without a usable error the value alone.
std::string measured_text(const Measurement& figure, const std::string& unit);

/// The figure in another unit.
Measurement scaled(const Measurement& figure, double factor);

}  // namespace roadstereo::io
