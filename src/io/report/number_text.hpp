#pragma once

#include <string>

#include "roadstereo/damage.hpp"

namespace roadstereo::io {

// Numbers in reports, rounded according to their error.

/// Formats a value with three significant digits.
std::string value_text(double value, const std::string& unit);

/// Formats "45.2 ± 1.3 mm": the error has two digits if it starts with 1 or 2, else one; the value has the same number
/// of decimals. Without a valid error only the value is shown.
std::string measured_text(const Measurement& measured, const std::string& unit);

/// Puts "≥" before the text of a value that is only a lower bound, as the area of what the border cuts is.
std::string bound_text(bool is_lower_bound, const std::string& text);

/// Converts a measurement to another unit.
Measurement scaled(const Measurement& measured, double factor);

}  // namespace roadstereo::io
