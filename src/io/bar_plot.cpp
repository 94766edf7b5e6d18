#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "io/frame_mat.hpp"
#include "io/plot_axes.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/plot.hpp"

namespace roadstereo::io {
namespace {

PlotAxes make_axes(const BarGroups& bars) {
  PlotAxes axes{bars.title, "", bars.y_label, {}, {}, {}};
  std::vector<double> values;
  for (std::size_t i = 0; i < bars.values.size(); ++i) {
    if (bars.values[i].size() != bars.groups.size()) {
      fail("a series of the plot \"", bars.title, "\" has ", bars.values[i].size(), " values for ", bars.groups.size(),
           " groups");
    }
    values.insert(values.end(), bars.values[i].begin(), bars.values[i].end());
  }
  for (std::size_t i = 0; i < bars.series.size(); ++i) axes.legend.push_back({bars.series[i], series_colour(i), false});
  if (bars.series.size() != bars.values.size() || !find_range(values, axes.y)) {
    fail("the plot \"", bars.title, "\" has no bar to show, or not one name per series");
  }
  const bool below_zero = std::any_of(values.begin(), values.end(), [](double value) { return value < 0; });
  if (!below_zero) axes.y.lowest = 0;
  axes.y.highest = std::max(axes.y.highest, 0.0);
  if (bars.y_highest) axes.y.highest = std::min(axes.y.highest, *bars.y_highest);
  return axes;
}

/// The value of a bar that is cut off, upwards in its top.
void draw_cut_value(cv::Mat& picture, const cv::Rect& bar, double value) {
  constexpr int max_length = 60;
  constexpr int two_digits = 10;
  const int height = std::clamp(bar.width - 4, 6, plot_text);
  const cv::Point centre(bar.x + bar.width / 2, bar.y + max_length / 2);
  put_text_upwards(picture, number_text(value, value < two_digits ? 1 : 0), centre, height, max_length, paper);
}

}  // namespace

Frame draw_bars(const BarGroups& bars, int width, int height) {
  const PlotAxes axes = make_axes(bars);
  cv::Mat picture(height, width, CV_8UC3, paper);
  draw_axes(picture, axes, false);
  const cv::Rect area = plot_area(axes, picture.size());
  const auto y_of = [&](double value) { return area.br().y - 1 - cvRound(axes.y.share(value) * (area.height - 1)); };
  const double group_width = static_cast<double>(area.width) / static_cast<double>(bars.groups.size());
  constexpr double filled_share = 0.8;
  const double bar_width = filled_share * group_width / static_cast<double>(bars.series.size());
  for (std::size_t group = 0; group < bars.groups.size(); ++group) {
    const double middle = area.x + (static_cast<double>(group) + 0.5) * group_width;
    for (std::size_t series = 0; series < bars.series.size(); ++series) {
      const double value = bars.values[series][group];
      if (!axes.y.can_show(value)) continue;
      const double left = middle + (static_cast<double>(series) / static_cast<double>(bars.series.size()) - 0.5) *
                                       filled_share * group_width;
      const cv::Point one(cvRound(left), y_of(std::min(value, axes.y.highest)));
      const cv::Point other(std::max(one.x, cvRound(left + bar_width) - 2), y_of(0));
      cv::rectangle(picture, one, other, series_colour(series), cv::FILLED);
      if (value > axes.y.highest) draw_cut_value(picture, {one, other}, value);
    }
    const std::string& name = bars.groups[group];
    put_text(picture, name, {cvRound(middle), area.br().y + 2 * plot_text},
             fitting_height(name, plot_text, cvRound(group_width)), ink, Align::centre);
  }
  for (const double y : bars.horizontal_lines) {
    draw_dashed(picture, cv::Point(area.x, y_of(y)), cv::Point(area.br().x, y_of(y)), ink, 1);
  }
  return frame_from(picture, ChannelOrder::bgr);
}

}  // namespace roadstereo::io
