#include "roadstereo/io/map_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "core/round_length.hpp"
#include "io/damage_colours.hpp"
#include "io/drawing.hpp"
#include "io/frame_mat.hpp"
#include "io/panels.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/jpeg.hpp"

namespace roadstereo::io {
namespace {

constexpr int panel_side_px = 1200;  ///< of a panel, pixels
constexpr int letters_px = 13;

/// Means of the cells that share a pixel, north up.
class Overview {
 public:
  Overview(const MapBox& bounds, const ReadMap& read, const ReadMap& relief)
      : bounds_(bounds), cells_(1 + (std::max(bounds.columns, bounds.rows) - 1) / panel_side_px) {
    const int width = (bounds.columns - 1) / cells_ + 1, height = (bounds.rows - 1) / cells_ + 1;
    colours_ = cv::Mat(height, width, CV_32FC3, cv::Scalar::all(0));
    relief_.assign(width, height, 0.0F);
    counts_.assign(width, height, 0);
    constexpr int block = 512;
    for (int v = 0; v < bounds.rows; v += block) {
      for (int u = 0; u < bounds.columns; u += block) {
        const int columns = std::min(block, bounds.columns - u), rows = std::min(block, bounds.rows - v);
        const MapBox box{bounds.i0 + u, bounds.j0 + bounds.rows - v - rows, columns, rows};
        add(u, v, read(box), relief(box));
      }
    }
    finish();
  }

  const cv::Mat& colours() const { return colours_; }     ///< BGR, white without a measurement
  const Image<float>& relief() const { return relief_; }  ///< metres; NaN without a measurement
  const cv::Mat& empty() const { return empty_; }         ///< 255 without a measurement
  const cv::Rect& measured() const { return measured_; }  ///< the smallest box with all measurements
  /// Pixel of a point of the map.
  cv::Point2d pixel(double x_cells, double y_cells) const {
    return {(x_cells - bounds_.i0) / cells_, (bounds_.j0 + bounds_.rows - y_cells) / cells_};
  }
  int cells_per_pixel() const { return cells_; }

 private:
  void add(int u0, int v0, const MapRaster& cells, const MapRaster& relief) {
    for (int v = 0; v < cells.box.rows; ++v) {
      for (int u = 0; u < cells.box.columns; ++u) {
        if (cells.views(u, v) == 0 || !std::isfinite(relief.height(u, v))) continue;
        const int column = (u0 + u) / cells_, row = (v0 + v) / cells_;
        const auto& [red, green, blue] = cells.colour(u, v);
        colours_.at<cv::Vec3f>(row, column) += cv::Vec3f(blue, green, red);
        relief_(column, row) += relief.height(u, v);
        ++counts_(column, row);
      }
    }
  }

  void finish() {
    cv::Mat bgr(colours_.size(), CV_8UC3, paper);
    empty_ = cv::Mat(colours_.size(), CV_8UC1, cv::Scalar(0));
    std::vector<cv::Point> seen;
    for (int v = 0; v < bgr.rows; ++v) {
      for (int u = 0; u < bgr.cols; ++u) {
        const auto count = static_cast<float>(counts_(u, v));
        relief_(u, v) = count > 0 ? relief_(u, v) / count : std::numeric_limits<float>::quiet_NaN();
        if (count == 0) empty_.at<std::uint8_t>(v, u) = 255;
        if (count == 0) continue;
        bgr.at<cv::Vec3b>(v, u) = cv::Vec3b(colours_.at<cv::Vec3f>(v, u) / count);
        seen.emplace_back(u, v);
      }
    }
    if (seen.empty()) fail("the map is empty");
    measured_ = cv::boundingRect(seen);
    colours_ = bgr;
  }

  MapBox bounds_;
  int cells_;
  cv::Mat colours_, empty_;
  Image<float> relief_;
  Image<int> counts_;
  cv::Rect measured_;
};

/// Places the measured part of an overview on a panel: cropped, small maps enlarged, long ones turned clockwise.
class Panel {
 public:
  explicit Panel(const Overview& overview)
      : overview_(overview),
        turned_(overview.measured().height > overview.measured().width),
        scale_(std::max(1, panel_side_px / std::max(overview.measured().width, overview.measured().height))) {}

  cv::Mat place(const cv::Mat& whole) const {
    cv::Mat part;
    cv::resize(whole(overview_.measured()), part, {}, scale_, scale_, cv::INTER_NEAREST);
    if (turned_) cv::rotate(part, part, cv::ROTATE_90_CLOCKWISE);
    return part;
  }
  cv::Point pixel(double x_cells, double y_cells) const {
    const cv::Rect& box = overview_.measured();
    const cv::Point2d at = (overview_.pixel(x_cells, y_cells) - cv::Point2d(box.x, box.y)) * scale_;
    return turned_ ? cv::Point(cvRound(box.height * scale_ - 1 - at.y), cvRound(at.x))
                   : cv::Point(cvRound(at.x), cvRound(at.y));
  }
  double pixels_per_cell() const { return static_cast<double>(scale_) / overview_.cells_per_pixel(); }
  bool turned() const { return turned_; }

 private:
  const Overview& overview_;
  bool turned_;
  int scale_;
};

/// Outlines of a footprint on a panel.
std::vector<std::vector<cv::Point>> outlines_of(const MapCells& footprint, const Panel& panel, double cell_m) {
  if (footprint.empty()) return {};
  int column0 = footprint.front()[0], column1 = column0;
  const int row0 = footprint.front()[1], row1 = footprint.back()[1];
  for (const auto& [column, row] : footprint) {
    column0 = std::min(column0, column);
    column1 = std::max(column1, column);
  }
  cv::Mat mask(row1 - row0 + 1, column1 - column0 + 1, CV_8UC1, cv::Scalar(0));
  for (const auto& [column, row] : footprint) mask.at<std::uint8_t>(row - row0, column - column0) = 1;
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(mask, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  const double cells = footprint_m / cell_m;
  for (auto& outline : outlines) {
    for (cv::Point& at : outline) at = panel.pixel((column0 + at.x + 0.5) * cells, (row0 + at.y + 0.5) * cells);
  }
  return outlines;
}

void draw_damages(cv::Mat& picture, const Panel& panel, double cell_m, std::span<const RoadDamageRecord> damages) {
  const cv::Scalar dark{20, 20, 20};
  for (const RoadDamageRecord& damage : damages) {
    const auto outlines = outlines_of(damage.best.footprint, panel, cell_m);
    const auto [red, green, blue] = damage_colour(damage.best.damage.kind, damage.severity);
    cv::polylines(picture, outlines, true, dark, 4, cv::LINE_AA);
    cv::polylines(picture, outlines, true, cv::Scalar(blue, green, red), 2, cv::LINE_AA);
  }
  for (const RoadDamageRecord& damage : damages) {  // numbers on top
    const std::string id = std::to_string(damage.id);
    const cv::Point at = panel.pixel(damage.best.at_m[0] / cell_m, damage.best.at_m[1] / cell_m);
    put_haloed_text(picture, id, {at.x - text_width(id, letters_px) / 2, at.y + letters_px / 2}, letters_px,
                    {255, 255, 255}, dark);
  }
}

/// Symmetric scale in millimetres that covers 99 % of the heights, at least ± 5 mm.
ColourScale relief_scale(const Image<float>& relief_mm) {
  constexpr double min_half_range_mm = 5;
  double half_range = min_half_range_mm;
  for (const double end : percentiles(relief_mm, {0.5, 99.5})) half_range = std::max(half_range, std::abs(end));
  return {-half_range, half_range, true, "above the road, mm"};
}

/// Scale bar, and which way the axes point.
void draw_legend(cv::Mat& canvas, cv::Point at, const Panel& panel, int width, const MapReference& reference) {
  const double pixels_per_m = panel.pixels_per_cell() / reference.cell_m;
  const double bar_m = round_length(width / pixels_per_m / 5);
  const int length = cvRound(bar_m * pixels_per_m);
  cv::line(canvas, at, {at.x + length, at.y}, ink, 3);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(bar_m))));
  put_text(canvas, number_text(bar_m, decimals) + " m", {at.x + length + letters_px, at.y + letters_px / 2}, letters_px,
           ink);
  const std::string way = reference.crs.empty() ? (panel.turned() ? "ahead (+y) to the right" : "ahead (+y) up")
                                                : (panel.turned() ? "north to the right" : "north up");
  put_text(canvas, way, {at.x + width, at.y + letters_px / 2}, letters_px, ink, Align::right);
}

}  // namespace

std::vector<std::uint8_t> map_picture(const MapBox& bounds, const MapReference& reference, const ReadMap& read,
                                      const ReadMap& relief, std::span<const RoadDamageRecord> damages) {
  constexpr int quality = 85, gap = 10, legend = 3 * letters_px;
  if (bounds.empty()) fail("the map is empty");
  const Overview overview(bounds, read, relief);
  const Panel panel(overview);
  Image<float> relief_mm(overview.relief().width(), overview.relief().height());
  const float* const metres = overview.relief().row(0);
  std::transform(metres, metres + relief_mm.pixels(), relief_mm.row(0), [](float height) { return 1000 * height; });
  const ColourScale scale = relief_scale(relief_mm);
  cv::Mat coloured = colour_pixels(relief_mm, scale);
  coloured.setTo(paper, overview.empty());
  std::array<cv::Mat, 2> panels{panel.place(overview.colours()), panel.place(coloured)};
  for (cv::Mat& picture : panels) draw_damages(picture, panel, reference.cell_m, damages);
  const int width = panels[0].cols, bar_height = std::max(panels[0].rows, 8 * letters_px);
  const int bar_width = scale_bar_width(scale, bar_height, letters_px);
  cv::Mat canvas(panels[0].rows + gap + bar_height + legend, width + bar_width, CV_8UC3, paper);
  panels[0].copyTo(canvas(cv::Rect({0, 0}, panels[0].size())));
  const int top = panels[0].rows + gap;
  panels[1].copyTo(canvas(cv::Rect({0, top}, panels[1].size())));
  draw_scale_bar(canvas, {width, top, bar_width, bar_height}, scale, letters_px);
  draw_legend(canvas, {0, canvas.rows - legend / 2}, panel, width, reference);
  return encode_jpeg(frame_from(canvas, ChannelOrder::bgr).view(), quality, canvas.cols);
}

}  // namespace roadstereo::io
