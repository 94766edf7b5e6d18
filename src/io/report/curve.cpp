#include "io/report/curve.hpp"

#include <algorithm>
#include <cmath>

#include "io/report/markup.hpp"
#include "io/report/svg_axes.hpp"
#include "io/report/templates.hpp"

namespace roadstereo::io {
namespace {

/// Range of the finite values with a margin.
SvgAxis value_axis(const std::vector<double>& values) {
  constexpr double margin_share = 0.08;
  SvgAxis axis{std::nan(""), std::nan(""), plot_bottom, plot_top};
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    axis.lowest = std::fmin(axis.lowest, value);
    axis.highest = std::fmax(axis.highest, value);
  }
  const double margin = std::max(margin_share * (axis.highest - axis.lowest), 1e-6 + 1e-3 * std::abs(axis.highest));
  axis.lowest -= margin;
  axis.highest += margin;
  return axis;
}

}  // namespace

std::string curve_svg(const std::vector<double>& time, const std::vector<double>& values, const std::string& x_label,
                      const std::string& y_label) {
  constexpr std::size_t max_points = 1000;
  const SvgAxis x{time.front(), std::max(time.back(), time.front() + 1e-6), plot_left, plot_right};
  const SvgAxis y = value_axis(values);
  const std::size_t step = 1 + values.size() / max_points;
  std::string path;
  bool down = false;
  for (std::size_t i = 0; i < values.size(); i += step) {
    const bool known = std::isfinite(values[i]);
    const bool alone = known && !down && (i + step >= values.size() || !std::isfinite(values[i + step]));
    if (known) {
      path +=
          (down ? "L" : "M") + coordinate_text(x.coordinate(time[i])) + " " + coordinate_text(y.coordinate(values[i]));
    }
    if (alone) path += "h.1";
    down = known;
  }
  return fill(templates::curve,
              {{"ticks", x_ticks(x, 1) + y_ticks(y, 1)}, {"path", path}, {"x_label", x_label}, {"y_label", y_label}});
}

}  // namespace roadstereo::io
