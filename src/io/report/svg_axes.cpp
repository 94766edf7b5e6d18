#include "io/report/svg_axes.hpp"

#include "io/drawing.hpp"
#include "io/report/markup.hpp"

namespace roadstereo::io {
namespace {

/// A tick label; `kind` sets its anchor.
std::string tick_text(double x, double y, const char* kind, const std::string& text) {
  return "<text class=\"" + std::string(kind) + "\" x=\"" + coordinate_text(x) + "\" y=\"" + coordinate_text(y) +
         "\">" + escaped(text) + "</text>";
}

}  // namespace

std::string coordinate_text(double coordinate) {
  return number_text(coordinate, 1);
}

std::string x_ticks(const SvgAxis& x, double unit) {
  constexpr int max_ticks = 7;
  const Ticks ticks = round_ticks(x.lowest * unit, x.highest * unit, max_ticks);
  std::string marks;
  for (const double value : ticks.values) {
    const double at = x.coordinate(value / unit);
    marks += "<path class=\"grid\" d=\"M" + coordinate_text(at) + " " + coordinate_text(plot_top) + "V" +
             coordinate_text(plot_bottom) + "\"/>" +
             tick_text(at, plot_bottom + 16, "below", number_text(value, ticks.decimals));
  }
  return marks;
}

std::string y_ticks(const SvgAxis& y, double unit) {
  constexpr int max_ticks = 6;
  const Ticks ticks = round_ticks(y.lowest * unit, y.highest * unit, max_ticks);
  std::string marks;
  for (const double value : ticks.values) {
    const double at = y.coordinate(value / unit);
    marks += "<path class=\"grid\" d=\"M" + coordinate_text(plot_left) + " " + coordinate_text(at) + "H" +
             coordinate_text(plot_right) + "\"/>" +
             tick_text(plot_left - 7, at + 4, "beside", number_text(value, ticks.decimals));
  }
  return marks;
}

}  // namespace roadstereo::io
