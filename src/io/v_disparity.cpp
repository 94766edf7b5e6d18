#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "io/drawing.hpp"
#include "io/panels.hpp"

namespace roadstereo::io {
namespace {

const cv::Scalar line_colour{40, 130, 255};
constexpr double line_opacity = 0.7;

/// Range of disparities and rows in the plot.
struct PlotRange {
  double low_px = 0;
  double high_px = 1;
  int rows = 1;
  int columns = 1;
};

PlotRange plot_range(ImageView<const float> disparity) {
  PlotRange range{0, 1, disparity.height(), disparity.width()};
  const std::vector<double> ends = percentiles(disparity, {0.5, 99.5});
  if (ends.empty()) return range;
  const double margin = std::max(0.06 * (ends[1] - ends[0]), 1.0);
  range.low_px = ends[0] - margin;
  if (ends[0] >= 0) range.low_px = std::max(range.low_px, 0.0);
  range.high_px = ends[1] + margin;
  return range;
}

/// Histogram with linear interpolation between the two nearest cells, which are at least 1/8 px wide: avoids stripes of
/// quantised disparities.
cv::Mat count_pixels(ImageView<const float> disparity, const PlotRange& range, cv::Size plot) {
  const double span = range.high_px - range.low_px;
  const int columns = static_cast<int>(std::clamp(8 * span, 1.0, static_cast<double>(plot.width)));
  const int rows = std::min(plot.height, range.rows);
  cv::Mat counts = cv::Mat::zeros(rows, columns, CV_32FC1);
  for (int v = 0; v < range.rows; ++v) {
    const float* in = disparity.row(v);
    auto* out = counts.ptr<float>(static_cast<int>(static_cast<std::int64_t>(v) * rows / range.rows));
    for (int u = 0; u < range.columns; ++u) {
      if (!(in[u] >= range.low_px && in[u] < range.high_px)) continue;
      const double column_at = std::clamp((in[u] - range.low_px) / span * columns - 0.5, 0.0, columns - 1.0);
      const int column = static_cast<int>(column_at);
      const auto share = static_cast<float>(column_at - column);
      out[column] += 1 - share;
      if (share > 0) out[column + 1] += share;
    }
  }
  return counts;
}

cv::Mat histogram_picture(ImageView<const float> disparity, const PlotRange& range, cv::Size plot) {
  cv::Mat brightness = count_pixels(disparity, range, plot);
  cv::log(brightness + 1, brightness);
  double brightest = 0;
  cv::minMaxLoc(brightness, nullptr, &brightest);
  brightness.convertTo(brightness, CV_8U, brightest > 0 ? 255 / brightest : 0);
  cv::resize(brightness, brightness, plot, 0, 0, cv::INTER_NEAREST);
  cv::Mat picture;
  cv::cvtColor(brightness, picture, cv::COLOR_GRAY2BGR);
  return picture;
}

/// Draws the disparity of the road at column `u` over the rows.
void draw_road_line(cv::Mat& picture, const PlotRange& range, const DisparityPlane& road, double u, bool dashed,
                    int width) {
  const auto point_at = [&](double row_share) {
    const double v = row_share * (range.rows - 1);
    const double x = (road.disparity(u, v) - range.low_px) / (range.high_px - range.low_px);
    return cv::Point2d(x * picture.cols, row_share * (picture.rows - 1));
  };
  constexpr int pieces = 60;
  for (int i = 0; i < pieces; ++i) {
    if (dashed && i % 2 == 1) continue;
    const cv::Point2d from = point_at(static_cast<double>(i) / pieces);
    const cv::Point2d to = point_at(static_cast<double>(i + 1) / pieces);
    const double max_x = 4.0 * picture.cols;
    if (std::abs(from.x) > max_x || std::abs(to.x) > max_x) continue;
    cv::line(picture, from, to, line_colour, width, cv::LINE_AA);
  }
}

bool has_visible_roll(const DisparityPlane& road, int columns) {
  constexpr double visible_px = 0.5;
  return std::abs(road.a2) * columns > visible_px;
}

void draw_road(cv::Mat& picture, const PlotRange& range, const DisparityPlane& road, int text_height) {
  const int width = std::max(1, text_height / 8);
  cv::Mat over = picture.clone();
  draw_road_line(over, range, road, 0.5 * (range.columns - 1), false, width);
  if (has_visible_roll(road, range.columns)) {
    draw_road_line(over, range, road, 0, true, width);
    draw_road_line(over, range, road, range.columns - 1, true, width);
  }
  cv::addWeighted(over, line_opacity, picture, 1 - line_opacity, 0, picture);
}

/// Legend in the upper right corner, which is empty because disparities increase downwards.
void draw_legend(cv::Mat& picture, const DisparityPlane& road, int columns, int text_height) {
  std::vector<std::string> lines{"road, middle"};
  if (has_visible_roll(road, columns)) lines.emplace_back("road, sides");
  const int sample = 2 * text_height;
  int y = 2 * text_height;
  for (std::size_t i = 0; i < lines.size(); ++i, y += 2 * text_height) {
    const int room = picture.cols - sample - 3 * text_height;
    const int height = fitting_height(lines[i], text_height, room);
    const int right = picture.cols - text_height;
    const int left = right - text_width(lines[i], height) - sample - text_height / 2;
    const int thickness = std::max(1, text_height / 8);
    const cv::Rect back = cv::Rect(left - text_height / 2, y - text_height - text_height / 2,
                                   right - left + text_height, 2 * text_height) &
                          cv::Rect(0, 0, picture.cols, picture.rows);
    if (!back.empty()) picture(back) *= 0.35;
    const int middle = y - height / 2;
    const int end = left + (i == 0 ? sample : sample * 2 / 5);
    cv::line(picture, {left, middle}, {end, middle}, line_colour, thickness);
    if (i > 0) cv::line(picture, {left + sample * 3 / 5, middle}, {left + sample, middle}, line_colour, thickness);
    put_text(picture, lines[i], {right, y}, height, cv::Scalar::all(255), Align::right);
  }
}

void draw_axes(cv::Mat& canvas, cv::Rect plot, const PlotRange& range, int text_height) {
  const int tick = text_height / 2;
  const int line = std::max(1, text_height / 12);
  cv::rectangle(canvas, plot, ink);
  const Ticks across = round_ticks(range.low_px, range.high_px, std::clamp(plot.width / (6 * text_height), 2, 9));
  for (const double value : across.values) {
    const double share = (value - range.low_px) / (range.high_px - range.low_px);
    const int x = plot.x + cvRound(share * (plot.width - 1));
    cv::line(canvas, {x, plot.br().y}, {x, plot.br().y + tick}, ink, line);
    put_text(canvas, number_text(value, across.decimals), {x, plot.br().y + tick + text_height + text_height / 2},
             text_height, ink, Align::centre);
  }
  const Ticks down = round_ticks(0, range.rows - 1, std::clamp(plot.height / (3 * text_height), 2, 9));
  int widest = 0;
  for (const double value : down.values) {
    const std::string number = number_text(value, 0);
    const int y = plot.y + cvRound(value / std::max(range.rows - 1, 1) * (plot.height - 1));
    cv::line(canvas, {plot.x - tick, y}, {plot.x, y}, ink, line);
    put_text(canvas, number, {plot.x - tick - text_height / 2, y + text_height / 2}, text_height, ink, Align::right);
    widest = std::max(widest, text_width(number, text_height));
  }
  put_text(canvas, "disparity, px", {plot.x + plot.width / 2, plot.br().y + tick + 3 * text_height + text_height / 2},
           text_height, ink, Align::centre);
  put_text_upwards(canvas, "image row", {plot.x - tick - widest - 2 * text_height, plot.y + plot.height / 2},
                   text_height, plot.height, ink);
}

}  // namespace

cv::Size v_disparity_margin(int image_height, int text_height) {
  const std::string longest = number_text(image_height, 0);
  return {text_width(longest, text_height) + 4 * text_height, 5 * text_height};
}

void draw_v_disparity(cv::Mat& canvas, cv::Rect plot, ImageView<const float> disparity,
                      const std::optional<RollEstimate>& geometry, int text_height) {
  const PlotRange range = plot_range(disparity);
  cv::Mat picture = histogram_picture(disparity, range, plot.size());
  if (geometry) {
    draw_road(picture, range, geometry->plane, text_height);
    draw_legend(picture, geometry->plane, range.columns, text_height);
  }
  picture.copyTo(canvas(plot));
  draw_axes(canvas, plot, range, text_height);
}

}  // namespace roadstereo::io
