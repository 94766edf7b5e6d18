#include "io/source/split_views.hpp"

#include "io/frame_mat.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::io {
namespace {

/// Aspect ratios from 1280×1024 to wide screens; excludes half of a 16:9 image.
bool is_a_view(double width, double height) {
  constexpr double min_aspect = 1.25;
  constexpr double max_aspect = 2.4;
  return width >= min_aspect * height && width <= max_aspect * height;
}

StereoLayout layout_of_shape(const std::string& source, int width, int height) {
  if (is_a_view(0.5 * width, height)) return StereoLayout::side_by_side;
  if (is_a_view(width, 0.5 * height)) return StereoLayout::top_bottom;
  fail(source, ": the image has ", width, "×", height, " pixels; its halves have no plausible aspect ratio, neither ",
       "side by side (", 0.5 * width, "×", height, ") nor one above the other (", width, "×", 0.5 * height,
       "); if it has two views, set --layout side-by-side or --layout top-bottom");
}

}  // namespace

StereoLayout find_layout(const std::string& source, int width, int height, StereoLayout wanted) {
  const StereoLayout layout = wanted == StereoLayout::automatic ? layout_of_shape(source, width, height) : wanted;
  if (layout == StereoLayout::side_by_side && width % 2 != 0) {
    fail(source, ": the image is ", width, " pixels wide; two views side by side need an even width");
  }
  if (layout == StereoLayout::top_bottom && height % 2 != 0) {
    fail(source, ": the image is ", height, " pixels high; two views one above the other need an even height");
  }
  return layout;
}

Frame picture_frame(const std::string& source, const cv::Mat& picture) {
  if (picture.depth() != CV_8U && picture.depth() != CV_16U) {
    fail(source, ": the samples of the image have ", 8 * picture.elemSize1(),
         " bits or a sign; they must be unsigned integers of 8 or 16 bits");
  }
  switch (picture.channels()) {
    case 1:
      return frame_from(picture, ChannelOrder::grey);
    case 3:
      return frame_from(picture, ChannelOrder::bgr);
    case 4:
      return frame_from(picture, ChannelOrder::bgra);
    default:
      fail(source, ": the image has ", picture.channels(), " channels; it must have 1, 3 or 4");
  }
}

void split_views(const std::string& source, const cv::Mat& picture, StereoLayout layout, SourcePair& pair) {
  const bool beside = layout == StereoLayout::side_by_side;
  const cv::Size view(beside ? picture.cols / 2 : picture.cols, beside ? picture.rows : picture.rows / 2);
  const cv::Point second(beside ? view.width : 0, beside ? 0 : view.height);
  pair.left = picture_frame(source, picture(cv::Rect({0, 0}, view)));
  pair.right = picture_frame(source, picture(cv::Rect(second, view)));
}

}  // namespace roadstereo::io
