#pragma once

#include <string>

namespace roadstereo::io {

/// Plot area of the drawings of 520×246, pixels.
inline constexpr double plot_left = 66, plot_right = 508, plot_top = 18, plot_bottom = 204;

/// One axis: maps values to coordinates of the drawing.
struct SvgAxis {
  double lowest = 0, highest = 1;
  double from = 0, to = 1;

  double coordinate(double value) const { return from + (value - lowest) / (highest - lowest) * (to - from); }
};

/// Formats a coordinate with one decimal.
std::string coordinate_text(double coordinate);

/// Returns grid lines and labels of an axis as SVG; the labels are the values times `unit`.
std::string x_ticks(const SvgAxis& x, double unit);
std::string y_ticks(const SvgAxis& y, double unit);

}  // namespace roadstereo::io
