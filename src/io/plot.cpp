#include "io/plot.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "io/frame_mat.hpp"
#include "io/plot_axes.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

PlotAxes make_axes(const Panel& panel) {
  PlotAxes axes{panel.title, panel.x_label, panel.y_label, {}, {0, 1, panel.log_y}, {}};
  std::vector<double> xs, ys;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    if (curve.x.size() != curve.y.size()) {
      fail("curve \"", curve.name, "\" of the plot \"", panel.title, "\" has ", curve.x.size(), " x but ",
           curve.y.size(), " y");
    }
    for (std::size_t j = 0; j < curve.x.size(); ++j) {
      if (!axes.x.can_show(curve.x[j]) || !axes.y.can_show(curve.y[j])) continue;
      xs.push_back(curve.x[j]);
      ys.push_back(curve.y[j]);
    }
    if (!curve.name.empty()) axes.legend.push_back({curve.name, series_colour(i)});
  }
  if (!find_range(xs, axes.x) || !find_range(ys, axes.y)) fail("the plot \"", panel.title, "\" has no point to show");
  axes.y.highest = panel.y_highest.value_or(axes.y.highest);
  if (!(axes.y.lowest < axes.y.highest)) {
    fail("the plot \"", panel.title, "\" shall reach from ", axes.y.lowest, " up to ", axes.y.highest);
  }
  return axes;
}

/// Places of values inside the plot area.
class Canvas {
 public:
  Canvas(cv::Mat& panel, const PlotAxes& axes) : axes_(axes), area_(panel(plot_area(axes, panel.size()))) {}

  bool can_show(double x, double y) const { return axes_.x.can_show(x) && axes_.y.can_show(y); }
  cv::Point2d at(double x, double y) const {
    return {place(axes_.x.share(x), area_.cols), area_.rows - 1 - place(axes_.y.share(y), area_.rows)};
  }
  cv::Mat& area() { return area_; }

 private:
  /// What lies far outside stays far outside, within the numbers that OpenCV can draw.
  static double place(double share, int pixels) { return std::clamp(share, -10.0, 10.0) * (pixels - 1); }

  const PlotAxes& axes_;
  cv::Mat area_;
};

void draw_curve(Canvas& canvas, const Curve& curve, const cv::Scalar& colour) {
  constexpr int thickness = 2;
  constexpr int marker_radius = 4;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (!canvas.can_show(curve.x[i], curve.y[i])) continue;
    const cv::Point2d here = canvas.at(curve.x[i], curve.y[i]);
    if (curve.markers) cv::circle(canvas.area(), here, marker_radius, colour, cv::FILLED, cv::LINE_AA);
    if (i == 0 || !canvas.can_show(curve.x[i - 1], curve.y[i - 1])) continue;
    cv::line(canvas.area(), canvas.at(curve.x[i - 1], curve.y[i - 1]), here, colour, thickness, cv::LINE_AA);
  }
}

void draw_reference_lines(Canvas& canvas, const Panel& panel, const PlotAxes& axes) {
  const cv::Scalar grey{120, 120, 120};
  for (const double y : panel.horizontal_lines) {
    if (!axes.y.can_show(y)) continue;
    draw_dashed(canvas.area(), canvas.at(axes.x.lowest, y), canvas.at(axes.x.highest, y), grey, 1);
  }
}

}  // namespace

Frame draw_plot(const Panel& panel, int width, int height) {
  const PlotAxes axes = make_axes(panel);
  cv::Mat picture(height, width, CV_8UC3, paper);
  draw_axes(picture, axes);
  Canvas canvas(picture, axes);
  draw_reference_lines(canvas, panel, axes);
  for (std::size_t i = 0; i < panel.curves.size(); ++i) draw_curve(canvas, panel.curves[i], series_colour(i));
  return frame_from(picture, ChannelOrder::bgr);
}

}  // namespace roadstereo::io
