#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// Points of one plot line. NaN interrupts it; so does, on a logarithmic axis, what is not positive.
struct Curve {
  std::string name;  ///< in the legend; empty leaves it out of it
  std::vector<double> x;
  std::vector<double> y;
  bool line = true;
  bool markers = false;
  bool dashed = false;
};

/// One plot: curves over common axes.
struct Panel {
  std::string title;
  std::string x_label;  ///< with the unit
  std::string y_label;  ///< with the unit
  std::vector<Curve> curves;
  bool log_x = false;
  bool log_y = false;
  std::optional<double> y_lowest{};        ///< the smallest value of the curves when absent
  std::optional<double> y_highest{};       ///< the largest value of the curves when absent
  std::vector<double> horizontal_lines{};  ///< y of thin reference lines from side to side
  std::vector<double> vertical_lines{};    ///< x of thin reference lines from top to bottom
};

/// Draws the panels side by side. Throws Error naming the panel that has no point to show, or a curve whose x and y
/// differ in number.
Frame draw_plot(const std::vector<Panel>& panels, int panel_width = 640, int panel_height = 440);

/// Bars in groups, one bar per series in each.
struct BarGroups {
  std::string title;
  std::string y_label;  ///< with the unit
  std::vector<std::string> groups;
  std::vector<std::string> series;
  std::vector<std::vector<double>> values;  ///< of each series, one per group; NaN leaves the bar out
  std::optional<double> y_highest{};        ///< a taller bar is cut off there and carries its value
  std::vector<double> horizontal_lines{};   ///< y of thin reference lines from side to side
};

/// Draws grouped bars that stand on zero. Throws Error when there is no bar, or a series has another number of values
/// than there are groups.
Frame draw_bars(const BarGroups& bars, int width = 960, int height = 440);

}  // namespace roadstereo::io
