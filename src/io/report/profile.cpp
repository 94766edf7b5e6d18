#include "io/report/profile.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "io/drawing.hpp"
#include "io/report/markup.hpp"
#include "io/report/svg_axes.hpp"
#include "io/report/templates.hpp"

namespace roadstereo::io {
namespace {

constexpr double mm = 1000;
using Axis = SvgAxis;

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

std::string profile_svg(const CrossSection& section, const Damage& damage, const std::string& id, bool metric_depth) {
  const Axis x = position_axis(section), y = depth_axis(section);
  const bool metres = section.metric && x.highest - x.lowest >= 1;
  const double x_unit = section.metric && !metres ? mm : 1, y_unit = metric_depth ? mm : 1;
  Fields fields;
  fields["id"] = id;
  fields["ticks"] = x_ticks(x, x_unit) + y_ticks(y, y_unit);
  fields["area"] = area_path(section, x, y);
  fields["interpolated"] = curve_path(section, section.filled, x, y);
  fields["measured"] = curve_path(section, section.depth, x, y);
  fields["road"] = coordinate_text(y.coordinate(0));
  fields["deepest"] = deepest_mark(section, damage, x, y);
  fields["kind"] = name_of(damage.kind);
  fields["x_label"] =
      section.metric ? std::string("along the section, ") + (metres ? "m" : "mm") : "along the image, px";
  fields["y_label"] = metric_depth ? "depth, mm" : "depth, px";
  return fill(templates::profile, fields);
}

}  // namespace roadstereo::io
