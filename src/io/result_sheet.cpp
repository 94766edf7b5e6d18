#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "io/drawing.hpp"
#include "io/frame_mat.hpp"
#include "io/panels.hpp"

namespace roadstereo::io {
namespace {

constexpr int picture_width = 900;       // of one panel; the sheet is about 2000 wide
constexpr int min_picture_height = 260;  // leaves room for an axis
constexpr int max_picture_height = 900;
constexpr int text_height = 14;
constexpr int title_height = 20;

/// Layout of a panel; equal for all panels.
struct SheetLayout {
  cv::Size picture;  // image or map
  cv::Size panel;    // with title, scale bar and axis
  int margin = 24;
  int head = 4 * title_height;

  cv::Rect area(int column, int row) const {
    return {margin + column * (panel.width + margin), head + row * (panel.height + margin), panel.width, panel.height};
  }
  cv::Size sheet() const { return {2 * panel.width + 3 * margin, head + 2 * panel.height + 2 * margin}; }
};

constexpr int panel_head = 2 * title_height;

/// Size of the image scaled to the panel with its aspect ratio.
cv::Size picture_size(int width, int height) {
  const double scale =
      std::min(static_cast<double>(picture_width) / width, static_cast<double>(max_picture_height) / height);
  return {std::max(cvRound(scale * width), 1), std::max(cvRound(scale * height), 1)};
}

void draw_picture(cv::Mat& canvas, cv::Rect panel, const cv::Mat& picture, cv::Size size) {
  const bool downsamples = size.width < picture.cols;
  cv::Mat scaled;
  cv::resize(picture, scaled, size, 0, 0, downsamples ? cv::INTER_AREA : cv::INTER_NEAREST);
  scaled.copyTo(canvas(cv::Rect(panel.x, panel.y + panel_head, size.width, size.height)));
}

void draw_heading(cv::Mat& canvas, cv::Rect panel, const std::string& heading) {
  put_text(canvas, heading, {panel.x, panel.y + panel_head - title_height * 4 / 5}, text_height + 2, ink);
}

void draw_map(cv::Mat& canvas, cv::Rect panel, const SheetLayout& layout, ImageView<const float> map,
              const ColourScale& scale) {
  draw_picture(canvas, panel, colour_pixels(map, scale), layout.picture);
  const cv::Rect bar(panel.x + layout.picture.width, panel.y + panel_head, panel.width - layout.picture.width,
                     std::max(layout.picture.height, min_picture_height));
  draw_scale_bar(canvas, bar, scale, text_height);
}

}  // namespace

Frame result_sheet(const FrameView& left, double white_level, ImageView<const float> disparity,
                   ImageView<const float> transformed, double delta_t, const std::optional<RollEstimate>& geometry,
                   const std::string& title) {
  const ColourScale disparity_scale = percentile_scale(disparity, "disparity, px");
  const ColourScale damage_scale = transformed_scale(transformed, delta_t);
  const cv::Size axis = v_disparity_margin(disparity.height(), text_height);
  SheetLayout layout;
  layout.picture = picture_size(left.width, left.height);
  const int height = std::max(layout.picture.height, min_picture_height);
  const int bar = std::max(scale_bar_width(disparity_scale, height, text_height),
                           scale_bar_width(damage_scale, height, text_height));
  const int width = std::max(layout.picture.width, picture_width);
  layout.panel = {width + bar, panel_head + height + axis.height};

  cv::Mat canvas(layout.sheet(), CV_8UC3, paper);
  const int line = fitting_height(title, title_height, canvas.cols - 2 * layout.margin);
  put_text(canvas, title, {layout.margin, layout.head - title_height * 3 / 2}, line, ink);

  const cv::Rect image_panel = layout.area(0, 0);
  draw_heading(canvas, image_panel, "left image");
  draw_picture(canvas, image_panel, to_bgr(left, white_level), layout.picture);

  const cv::Rect disparity_panel = layout.area(1, 0);
  draw_heading(canvas, disparity_panel, "disparity (black: invalid)");
  draw_map(canvas, disparity_panel, layout, disparity, disparity_scale);

  const cv::Rect damage_panel = layout.area(0, 1);
  draw_heading(canvas, damage_panel, "transformed disparity (grey: intact road, red: below it, blue: above it)");
  draw_map(canvas, damage_panel, layout, transformed, damage_scale);

  const cv::Rect plot_panel = layout.area(1, 1);
  draw_heading(canvas, plot_panel, "v-disparity histogram and road model");
  const cv::Rect plot(plot_panel.x + axis.width, plot_panel.y + panel_head, width - axis.width, height);
  draw_v_disparity(canvas, plot, disparity, geometry, text_height);
  return frame_from(canvas, ChannelOrder::bgr);
}

}  // namespace roadstereo::io
