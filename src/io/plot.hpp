#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Points of one plot line. NaN interrupts it; so does, on a logarithmic axis, what is not positive.
struct Curve {
  std::string name;  ///< in the legend; empty leaves it out of it
  std::vector<double> x;
  std::vector<double> y;
  bool markers = false;
};

/// One plot: curves over common axes.
struct Panel {
  std::string title;
  std::string x_label;  ///< with the unit
  std::string y_label;  ///< with the unit
  std::vector<Curve> curves;
  bool log_y = false;
  std::optional<double> y_highest{};       ///< the largest value of the curves when absent
  std::vector<double> horizontal_lines{};  ///< y of thin reference lines from side to side
};

/// Draws the curves. Throws Error when there is no point to show, or a curve whose x and y differ in number.
Frame draw_plot(const Panel& panel, int width, int height);

}  // namespace roadstereo::io
#pragma GCC visibility pop
