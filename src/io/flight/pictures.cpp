#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "io/damage_outline.hpp"
#include "io/frame_mat.hpp"
#include "roadstereo/io/flight_pictures.hpp"
#include "roadstereo/io/jpeg.hpp"
#include "roadstereo/pixel_box.hpp"

namespace roadstereo::io {
namespace {

std::vector<std::uint8_t> jpeg_of(const cv::Mat& picture) {
  constexpr int quality = 82;
  return encode_jpeg(frame_from(picture, ChannelOrder::bgr).view(), quality, picture.cols);
}

/// Crops and scales the frame to 8-bit colour.
cv::Mat part_of(const FrameView& frame, double white_level, const PixelBox& box, double scale) {
  const cv::Mat whole = mat_over(frame);
  const cv::Mat part = whole(cv::Rect(box.u0, box.v0, box.width(), box.height()));
  const cv::Size size(std::max(1, cvRound(scale * part.cols)), std::max(1, cvRound(scale * part.rows)));
  cv::Mat small = part;
  if (scale < 1) cv::resize(part, small, size, 0, 0, cv::INTER_AREA);
  return to_bgr(frame_from(small, frame.order).view(), white_level);
}

}  // namespace

std::vector<std::uint8_t> frame_thumbnail(const FrameView& left, double white_level, const DamageMap& map, int width) {
  const double scale = std::min(1.0, static_cast<double>(width) / left.width);
  cv::Mat small = part_of(left, white_level, {0, 0, left.width - 1, left.height - 1}, scale);
  for (const Damage& damage : map.damages) draw_outline(small, map, damage, 1, {}, scale);
  return jpeg_of(small);
}

std::vector<std::uint8_t> damage_picture(const FrameView& left, double white_level, const DamageMap& map,
                                         const Damage& damage, int side) {
  constexpr double margin_share = 0.4;
  constexpr int min_margin_px = 16;
  const PixelBox box = box_with_margin(map, damage, margin_share, min_margin_px);
  const double scale = std::min(1.0, static_cast<double>(side) / std::max(box.width(), box.height()));
  cv::Mat picture = part_of(left, white_level, box, scale);
  draw_outline(picture, map, damage, 1, {box.u0, box.v0}, scale);
  return jpeg_of(picture);
}

}  // namespace roadstereo::io
