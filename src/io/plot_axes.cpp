#include "io/plot_axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace roadstereo::io {
namespace {

const cv::Scalar grid{225, 225, 225};
constexpr int gap = plot_text;
constexpr int swatch = 24;  // length of a legend's piece of line, pixels
constexpr int legend_row = plot_text + 8;

/// Where each entry of the legend starts, relative to its strip; entries that do not fit start a new row.
std::vector<cv::Point> legend_places(const std::vector<LegendEntry>& legend, int width) {
  std::vector<cv::Point> places;
  cv::Point at(0, 0);
  for (const LegendEntry& entry : legend) {
    const int length = swatch + gap / 2 + text_width(entry.name, plot_text) + 2 * gap;
    if (at.x > 0 && at.x + length > width) at = {0, at.y + legend_row};
    places.push_back(at);
    at.x += length;
  }
  return places;
}

constexpr int legend_left = 6 * plot_text;

int legend_height(const PlotAxes& axes, int panel_width) {
  const auto places = legend_places(axes.legend, panel_width - legend_left - gap);
  return places.empty() ? 0 : places.back().y + legend_row;
}

void draw_legend(cv::Mat& panel, const PlotAxes& axes, int top) {
  const auto places = legend_places(axes.legend, panel.cols - legend_left - gap);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const LegendEntry& entry = axes.legend[i];
    const cv::Point at = places[i] + cv::Point(legend_left, top + plot_text);
    const cv::Point2d middle(at.x, at.y - plot_text / 2.0);
    const cv::Point2d end = middle + cv::Point2d(swatch, 0);
    cv::line(panel, middle, end, entry.colour, 3, cv::LINE_AA);
    put_text(panel, entry.name, at + cv::Point(swatch + gap / 2, 0), plot_text, ink);
  }
}

void draw_x_ticks(cv::Mat& panel, const AxisRange& range, cv::Rect area) {
  const AxisTicks ticks = axis_ticks(range, std::max(2, area.width / (6 * plot_text)));
  for (std::size_t i = 0; i < ticks.values.size(); ++i) {
    const int x = area.x + cvRound(range.share(ticks.values[i]) * (area.width - 1));
    cv::line(panel, {x, area.y}, {x, area.br().y - 1}, grid);
    cv::line(panel, {x, area.br().y}, {x, area.br().y + gap / 2}, ink);
    put_text(panel, ticks.texts[i], {x, area.br().y + 2 * gap}, plot_text, ink, Align::centre);
  }
}

void draw_y_ticks(cv::Mat& panel, const AxisRange& range, cv::Rect area) {
  const AxisTicks ticks = axis_ticks(range, std::max(2, area.height / (3 * plot_text)));
  for (std::size_t i = 0; i < ticks.values.size(); ++i) {
    const int y = area.br().y - 1 - cvRound(range.share(ticks.values[i]) * (area.height - 1));
    cv::line(panel, {area.x, y}, {area.br().x - 1, y}, grid);
    cv::line(panel, {area.x - gap / 2, y}, {area.x, y}, ink);
    put_text(panel, ticks.texts[i], {area.x - gap, y + plot_text / 2}, plot_text, ink, Align::right);
  }
}

/// Powers of ten, or also twice and five times those when there are few.
AxisTicks logarithmic_ticks(const AxisRange& range) {
  AxisTicks ticks;
  const int first = static_cast<int>(std::floor(std::log10(range.lowest)));
  const int last = static_cast<int>(std::ceil(std::log10(range.highest)));
  const bool few = last - first <= 3;
  for (int power = first; power <= last; ++power) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * std::pow(10.0, power);
      if ((digit > 1 && !few) || value < range.lowest || value > range.highest) continue;
      ticks.values.push_back(value);
      ticks.texts.push_back(number_text(value, std::max(0, -power)));
    }
  }
  return ticks;
}

}  // namespace

cv::Scalar series_colour(std::size_t index) {
  static const std::array<cv::Scalar, 8> colours{{{178, 114, 0},
                                                  {0, 94, 213},
                                                  {115, 158, 0},
                                                  {167, 121, 204},
                                                  {0, 159, 230},
                                                  {233, 180, 86},
                                                  {90, 90, 90},
                                                  {66, 200, 220}}};
  return colours[index % colours.size()];
}

bool AxisRange::can_show(double value) const {
  return std::isfinite(value) && (!logarithmic || value > 0);
}

double AxisRange::share(double value) const {
  if (logarithmic) return std::log(value / lowest) / std::log(highest / lowest);
  return (value - lowest) / (highest - lowest);
}

bool find_range(const std::vector<double>& values, AxisRange& range) {
  std::vector<double> shown;
  for (const double value : values) {
    if (range.can_show(value)) shown.push_back(range.logarithmic ? std::log(value) : value);
  }
  if (shown.empty()) return false;
  const auto [least, most] = std::minmax_element(shown.begin(), shown.end());
  constexpr double margin_share = 0.04;
  const double span = *most - *least;
  const double margin = span > 0 ? margin_share * span : 0.5 * std::max(1e-3, std::abs(*most));
  range.lowest = *least - margin;
  range.highest = *most + margin;
  if (range.logarithmic) {
    range.lowest = std::exp(range.lowest);
    range.highest = std::exp(range.highest);
  }
  return true;
}

AxisTicks axis_ticks(const AxisRange& range, int most) {
  if (range.logarithmic) return logarithmic_ticks(range);
  const Ticks round = round_ticks(range.lowest, range.highest, most);
  AxisTicks ticks{round.values, {}};
  for (const double value : round.values) ticks.texts.push_back(number_text(value, round.decimals));
  return ticks;
}

cv::Rect plot_area(const PlotAxes& axes, cv::Size panel) {
  const int left = 7 * plot_text;
  const int right = 2 * plot_text;
  const int top = 3 * plot_text + legend_height(axes, panel.width);
  const int bottom = 5 * plot_text;
  return {left, top, std::max(8, panel.width - left - right), std::max(8, panel.height - top - bottom)};
}

void draw_axes(cv::Mat& panel, const PlotAxes& axes) {
  const cv::Rect area = plot_area(axes, panel.size());
  const cv::Point title(panel.cols / 2, 2 * plot_text);
  put_text(panel, axes.title, title, fitting_height(axes.title, plot_text + 2, panel.cols), ink, Align::centre);
  draw_legend(panel, axes, 3 * plot_text - gap / 2);
  draw_x_ticks(panel, axes.x, area);
  draw_y_ticks(panel, axes.y, area);
  cv::rectangle(panel, area, ink);
  put_text(panel, axes.x_label, {area.x + area.width / 2, panel.rows - plot_text}, plot_text, ink, Align::centre);
  put_text_upwards(panel, axes.y_label, {plot_text, area.y + area.height / 2}, plot_text, area.height, ink);
}

void draw_dashed(cv::Mat& picture, cv::Point2d from, cv::Point2d to, const cv::Scalar& colour, int thickness) {
  constexpr double dash = 7;
  constexpr double period = 12;
  const double length = cv::norm(to - from);
  const int dashes = static_cast<int>(std::ceil(length / period));
  for (int k = 0; k < dashes; ++k) {
    const double start = k * period;
    const cv::Point2d first = from + (to - from) * (start / length);
    const cv::Point2d last = from + (to - from) * (std::min(start + dash, length) / length);
    cv::line(picture, first, last, colour, thickness, cv::LINE_AA);
  }
}

}  // namespace roadstereo::io
