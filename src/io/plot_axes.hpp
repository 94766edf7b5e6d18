#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "io/drawing.hpp"

namespace roadstereo::io {

/// Height of the letters of a plot, pixels.
inline constexpr int plot_text = 11;

/// Colour of the n-th curve, BGR: a palette that colour-blind eyes tell apart, used again from its start.
cv::Scalar series_colour(std::size_t index);

/// Values along one side of a plot.
struct AxisRange {
  double lowest = 0;
  double highest = 1;
  bool logarithmic = false;

  /// Whether the axis can show the value: finite, and positive on a logarithmic axis.
  bool can_show(double value) const;
  /// 0 at the lowest value, 1 at the highest.
  double share(double value) const;
};

/// The range of the values with a margin of some percent at either end; false when there is nothing to show.
bool find_range(const std::vector<double>& values, AxisRange& range);

/// Round numbers along an axis, with the text of each.
struct AxisTicks {
  std::vector<double> values;
  std::vector<std::string> texts;
};
AxisTicks axis_ticks(const AxisRange& range, int most);

/// One entry of the legend.
struct LegendEntry {
  std::string name;
  cv::Scalar colour;
};

/// What stands around the curves.
struct PlotAxes {
  std::string title, x_label, y_label;
  AxisRange x, y;
  std::vector<LegendEntry> legend;
};

/// Where the curves are drawn, inside a panel of that size.
cv::Rect plot_area(const PlotAxes& axes, cv::Size panel);

/// Draws title, legend, frame, grid and axes with their numbers.
void draw_axes(cv::Mat& panel, const PlotAxes& axes);

/// A line of dashes.
void draw_dashed(cv::Mat& picture, cv::Point2d from, cv::Point2d to, const cv::Scalar& colour, int thickness);

}  // namespace roadstereo::io
