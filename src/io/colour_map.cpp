#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "core/order_statistics.hpp"
#include "io/drawing.hpp"
#include "io/frame_mat.hpp"
#include "io/panels.hpp"

namespace roadstereo::io {
namespace {

/// A colour at a position of the scale, 0 … 1.
struct Stop {
  double at;
  cv::Vec3d bgr;
};

/// Diverging map: red below, grey at the road, blue above; distinguishable with red blindness. Saturation rises
/// quickly, so that shallow damage is visible.
constexpr std::size_t stop_count = 7;
const std::array<Stop, stop_count>& diverging_stops() {
  static const std::array<Stop, stop_count> stops{{{0.00, {25, 0, 80}},
                                                   {0.18, {35, 20, 190}},
                                                   {0.36, {85, 125, 245}},
                                                   {0.50, {228, 228, 228}},
                                                   {0.64, {225, 165, 90}},
                                                   {0.82, {180, 95, 25}},
                                                   {1.00, {95, 40, 5}}}};
  return stops;
}

cv::Mat diverging_table() {
  cv::Mat table(256, 1, CV_8UC3);
  const auto& stops = diverging_stops();
  for (int i = 0; i < 256; ++i) {
    const double at = i / 255.0;
    std::size_t next = 1;
    while (next + 1 < stops.size() && stops[next].at < at) ++next;
    const Stop& low = stops[next - 1];
    const Stop& high = stops[next];
    const double share = (at - low.at) / (high.at - low.at);
    table.at<cv::Vec3b>(i) = cv::Vec3b(low.bgr * (1 - share) + high.bgr * share);
  }
  return table;
}

/// Turbo without its darkest ends, which resemble the black of invalid pixels.
cv::Mat sequential_table() {
  constexpr int first = 16;
  constexpr int last = 246;
  cv::Mat levels(256, 1, CV_8UC1);
  for (int i = 0; i < 256; ++i) {
    levels.at<std::uint8_t>(i) = static_cast<std::uint8_t>(first + (last - first) * i / 255);
  }
  cv::Mat table;
  cv::applyColorMap(levels, table, cv::COLORMAP_TURBO);
  return table;
}

cv::Mat paint(const cv::Mat& levels, bool diverging) {
  cv::Mat picture;
  if (diverging) {
    cv::applyColorMap(levels, picture, diverging_table());
  } else {
    cv::applyColorMap(levels, picture, sequential_table());
  }
  return picture;
}

/// Robust standard deviation of the road around δt, from the values below δt only: vehicles and walls are above.
double road_scatter(ImageView<const float> transformed, double delta_t) {
  Image<float> below(transformed.width(), transformed.height());
  const auto level = static_cast<float>(delta_t);
  for (int v = 0; v < transformed.height(); ++v) {
    std::transform(transformed.row(v), transformed.row(v) + transformed.width(), below.row(v), [&](float value) {
      return value <= level ? level - value : std::numeric_limits<float>::quiet_NaN();
    });
  }
  const std::vector<double> middle = percentiles(below, {50});
  return middle.empty() ? 0.0 : gaussian_mad * middle.front();
}

struct BarLayout {
  int gap;
  int bar;
  int tick;
  int numbers;
  int label;

  int width() const { return gap + bar + tick + gap / 2 + numbers + gap / 2 + label; }
};

Ticks bar_ticks(const ColourScale& scale, int height, int text_height) {
  return round_ticks(scale.lowest, scale.highest, std::clamp(height / (3 * text_height), 2, 9));
}

BarLayout bar_layout(const ColourScale& scale, int height, int text_height) {
  BarLayout layout{text_height, 2 * text_height, text_height / 2, 0, 2 * text_height};
  const Ticks ticks = bar_ticks(scale, height, text_height);
  for (const double value : ticks.values) {
    layout.numbers = std::max(layout.numbers, text_width(number_text(value, ticks.decimals), text_height));
  }
  return layout;
}

}  // namespace

ColourScale percentile_scale(ImageView<const float> map, const std::string& label) {
  const std::vector<double> ends = percentiles(map, {1, 99});
  ColourScale scale{0, 1, false, label};
  if (ends.empty()) return scale;
  scale.lowest = ends[0];
  scale.highest = std::max(ends[1], ends[0] + 1e-3);
  return scale;
}

ColourScale transformed_scale(ImageView<const float> transformed, double delta_t) {
  constexpr double min_half_range_px = 1;
  constexpr double max_scatters = 20;
  const std::vector<double> ends = percentiles(transformed, {0.25, 99.75});
  double half_range = 0;
  for (const double end : ends) half_range = std::max(half_range, std::abs(end - delta_t));
  half_range = std::min(half_range, max_scatters * road_scatter(transformed, delta_t));
  half_range = std::max(half_range, min_half_range_px);
  return {delta_t - half_range, delta_t + half_range, true, "transformed, px (red: below road)"};
}

cv::Mat colour_pixels(ImageView<const float> map, const ColourScale& scale) {
  const double span = std::max(scale.highest - scale.lowest, 1e-9);
  cv::Mat levels(map.height(), map.width(), CV_8UC1);
  cv::Mat invalid(map.height(), map.width(), CV_8UC1);
  for (int v = 0; v < map.height(); ++v) {
    const float* in = map.row(v);
    for (int u = 0; u < map.width(); ++u) {
      const bool valid = std::isfinite(in[u]);
      const double level = valid ? std::clamp((in[u] - scale.lowest) / span, 0.0, 1.0) : 0.0;
      levels.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(std::lround(255 * level));
      invalid.at<std::uint8_t>(v, u) = valid ? 0 : 255;
    }
  }
  cv::Mat picture = paint(levels, scale.diverging);
  picture.setTo(cv::Scalar::all(0), invalid);
  return picture;
}

int scale_bar_width(const ColourScale& scale, int height, int text_height) {
  return bar_layout(scale, height, text_height).width();
}

void draw_scale_bar(cv::Mat& canvas, cv::Rect area, const ColourScale& scale, int text_height) {
  const BarLayout layout = bar_layout(scale, area.height, text_height);
  const cv::Rect bar(area.x + layout.gap, area.y + text_height, layout.bar, std::max(area.height - 2 * text_height, 2));
  cv::Mat ramp(bar.height, 1, CV_8UC1);
  for (int i = 0; i < bar.height; ++i) {
    ramp.at<std::uint8_t>(i) = static_cast<std::uint8_t>(255 - 255 * i / (bar.height - 1));
  }
  cv::Mat colours;
  cv::resize(paint(ramp, scale.diverging), colours, bar.size(), 0, 0, cv::INTER_NEAREST);
  colours.copyTo(canvas(bar));
  cv::rectangle(canvas, bar, ink);

  const int line = std::max(1, text_height / 12);
  const int numbers_left = bar.br().x + layout.tick + layout.gap / 2;
  const Ticks ticks = bar_ticks(scale, area.height, text_height);
  for (const double value : ticks.values) {
    const double share = (value - scale.lowest) / (scale.highest - scale.lowest);
    const int y = bar.br().y - 1 - cvRound(share * (bar.height - 1));
    cv::line(canvas, {bar.br().x, y}, {bar.br().x + layout.tick, y}, ink, line);
    put_text(canvas, number_text(value, ticks.decimals), {numbers_left + layout.numbers, y + text_height / 2},
             text_height, ink, Align::right);
  }
  const int label_middle = numbers_left + layout.numbers + layout.gap / 2 + layout.label / 2;
  put_text_upwards(canvas, scale.label, {label_middle, area.y + area.height / 2}, text_height, area.height, ink);
}

Frame colour_map(ImageView<const float> map, const ColourScale& scale) {
  const int text_height = text_height_for(map.height());
  const int height = std::max(map.height(), 8 * text_height);
  const int bar_width = scale_bar_width(scale, height, text_height);
  cv::Mat canvas(height, map.width() + bar_width, CV_8UC3, paper);
  colour_pixels(map, scale).copyTo(canvas(cv::Rect(0, 0, map.width(), map.height())));
  draw_scale_bar(canvas, {map.width(), 0, bar_width, height}, scale, text_height);
  return frame_from(canvas, ChannelOrder::bgr);
}

}  // namespace roadstereo::io
