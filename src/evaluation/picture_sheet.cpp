#include "evaluation/picture_sheet.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "io/drawing.hpp"
#include "io/frame_mat.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

constexpr int text = 12;
constexpr int title_height = 2 * text;
constexpr int gap = 8;
constexpr double white = 255;

struct PlacedCell {
  cv::Mat picture;
  std::string title;
  cv::Point at;
};

cv::Mat scaled_to(const Frame& frame, int width) {
  const cv::Mat picture = to_bgr(frame.view(), white);
  const int height = std::max(1, cvRound(static_cast<double>(picture.rows) * width / picture.cols));
  cv::Mat scaled;
  cv::resize(picture, scaled, {width, height}, 0, 0, width < picture.cols ? cv::INTER_AREA : cv::INTER_LINEAR);
  return scaled;
}

}  // namespace

Frame picture_sheet(const std::vector<std::vector<SheetCell>>& rows, int cell_width) {
  std::vector<PlacedCell> cells;
  cv::Size size(0, gap);
  for (const auto& row : rows) {
    int x = gap, tallest = 0;
    for (const SheetCell& cell : row) {
      cells.push_back({scaled_to(cell.picture, cell_width), cell.title, {x, size.height}});
      tallest = std::max(tallest, cells.back().picture.rows);
      x += cell_width + gap;
    }
    size.width = std::max(size.width, x);
    size.height += title_height + tallest + gap;
  }
  if (cells.empty()) fail("a sheet needs at least one picture");
  cv::Mat sheet(size, CV_8UC3, paper);
  for (const PlacedCell& cell : cells) {
    const int letters = fitting_height(cell.title, text, cell_width);
    put_text(sheet, cell.title, cell.at + cv::Point(0, title_height - text / 2), letters, ink);
    cell.picture.copyTo(sheet(cv::Rect(cell.at + cv::Point(0, title_height), cell.picture.size())));
  }
  return frame_from(sheet, ChannelOrder::bgr);
}

}  // namespace roadstereo::io
