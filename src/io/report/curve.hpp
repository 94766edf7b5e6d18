#pragma once

#include <string>
#include <vector>

namespace roadstereo::io {

/// Draws values over time as SVG; interrupted where a value is not finite. `time` ascends; both have one size.
std::string curve_svg(const std::vector<double>& time, const std::vector<double>& values, const std::string& x_label,
                      const std::string& y_label);

}  // namespace roadstereo::io
