#include "io/report/profile.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "io/drawing.hpp"
#include "io/report/markup.hpp"
#include "io/report/number_text.hpp"
#include "io/report/templates.hpp"

namespace roadstereo::io {
namespace {

constexpr double plot_left = 58, plot_right = 508, plot_top = 18, plot_bottom = 204;
constexpr double mm = 1000;

/// One axis: maps values to coordinates of the drawing.
struct Axis {
  double lowest = 0, highest = 1;
  double from = 0, to = 1;

  double coordinate(double value) const { return from + (value - lowest) / (highest - lowest) * (to - from); }
};

std::string coordinate_text(double coordinate) {
  return number_text(coordinate, 1);
}

/// The curve as an SVG path, interrupted at values that are not finite; about `max_points` points.
std::string curve_path(const CrossSection& section, const std::vector<double>& depths, const Axis& x, const Axis& y) {
  constexpr std::size_t max_points = 300;
  const std::size_t step = 1 + depths.size() / max_points;
  std::string path;
  bool down = false;
  for (std::size_t i = 0; i < depths.size(); i += step) {
    const bool known = std::isfinite(depths[i]);
    if (known)
      path += (down ? "L" : "M") + coordinate_text(x.coordinate(section.position[i])) + " " +
              coordinate_text(y.coordinate(depths[i]));
    down = known;
  }
  return path;
}

/// The area between the curve and the undamaged road.
std::string area_path(const CrossSection& section, const Axis& x, const Axis& y) {
  std::ostringstream path;
  const std::string road = coordinate_text(y.coordinate(0));
  const auto& depths = section.filled;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (!std::isfinite(depths[i])) continue;
    const std::string at = coordinate_text(x.coordinate(section.position[i]));
    if (i == 0 || !std::isfinite(depths[i - 1])) path << 'M' << at << ' ' << road;
    path << 'L' << at << ' ' << coordinate_text(y.coordinate(depths[i]));
    if (i + 1 == depths.size() || !std::isfinite(depths[i + 1])) path << 'L' << at << ' ' << road << 'Z';
  }
  return path.str();
}

/// A tick label; `kind` sets its anchor.
std::string tick_text(double x, double y, const char* kind, const std::string& text) {
  return "<text class=\"" + std::string(kind) + "\" x=\"" + coordinate_text(x) + "\" y=\"" + coordinate_text(y) +
         "\">" + escaped(text) + "</text>";
}

std::string x_ticks(const Axis& x, double unit) {
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

std::string y_ticks(const Axis& y, double unit) {
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

/// Range of the depths including 0, with margins for the label.
Axis depth_axis(const CrossSection& section) {
  constexpr double room = 0.16;
  Axis y{0, 0, plot_top, plot_bottom};
  for (const double depth : section.filled) {
    if (!std::isfinite(depth)) continue;
    y.lowest = std::min(y.lowest, depth);
    y.highest = std::max(y.highest, depth);
  }
  const double margin = room * std::max(y.highest - y.lowest, 1e-6);
  y.lowest -= margin;
  y.highest += margin;
  return y;
}

Axis position_axis(const CrossSection& section) {
  const auto [low, high] = std::minmax_element(section.position.begin(), section.position.end());
  return {*low, std::max(*high, *low + 1e-6), plot_left, plot_right};
}

/// Dot at the deepest pixel.
std::string deepest_mark(const CrossSection& section, const Damage& damage, const Axis& x, const Axis& y) {
  const auto found = std::find(section.pixel.begin(), section.pixel.end(), damage.deepest_px);
  if (found == section.pixel.end()) return "";
  const auto i = static_cast<std::size_t>(found - section.pixel.begin());
  if (!std::isfinite(section.filled[i])) return "";
  return "<circle class=\"deepest\" r=\"4\" cx=\"" + coordinate_text(x.coordinate(section.position[i])) + "\" cy=\"" +
         coordinate_text(y.coordinate(section.filled[i])) + "\"/>";
}

}  // namespace

std::string profile_svg(const CrossSection& section, const Damage& damage, bool metric_depth) {
  const Axis x = position_axis(section), y = depth_axis(section);
  const bool metres = section.metric && x.highest - x.lowest >= 1;
  const double x_unit = section.metric && !metres ? mm : 1, y_unit = metric_depth ? mm : 1;
  Fields fields;
  fields["id"] = std::to_string(damage.id);
  fields["ticks"] = x_ticks(x, x_unit) + y_ticks(y, y_unit);
  fields["area"] = area_path(section, x, y);
  fields["interpolated"] = curve_path(section, section.filled, x, y);
  fields["measured"] = curve_path(section, section.depth, x, y);
  fields["road"] = coordinate_text(y.coordinate(0));
  const bool rises = damage.kind == DamageKind::protrusion;  // the label is on the other side of the line
  fields["road_label"] = coordinate_text(y.coordinate(0) + (rises ? 15 : -6));
  fields["deepest"] = deepest_mark(section, damage, x, y);
  fields["kind"] = name_of(damage.kind);
  fields["x_label"] = section.metric ? std::string("along the road, ") + (metres ? "m" : "mm") : "along the image, px";
  fields["y_label"] = metric_depth ? "depth, mm" : "depth, px";
  return fill(templates::profile, fields);
}

}  // namespace roadstereo::io
