#include "io/damage_outline.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "io/damage_colours.hpp"

namespace roadstereo::io {
namespace {

cv::Scalar colour_of(const Damage& damage) {
  const auto [red, green, blue] = damage_colour(damage.kind, severity_of(damage));
  return {static_cast<double>(blue), static_cast<double>(green), static_cast<double>(red)};
}

/// Outlines of the region and of its holes, in pixels of the image.
std::vector<std::vector<cv::Point>> outlines(const DamageMap& map, const Damage& damage) {
  const auto& [u0, v0, u1, v1] = damage.box_px;
  cv::Mat mask(v1 - v0 + 1, u1 - u0 + 1, CV_8UC1);
  for (int v = 0; v < mask.rows; ++v) {
    const std::uint16_t* const ids = map.ids.row(v0 + v) + u0;
    std::transform(ids, ids + mask.cols, mask.ptr<std::uint8_t>(v),
                   [&](std::uint16_t id) { return id == damage.id ? std::uint8_t{255} : std::uint8_t{0}; });
  }
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_CCOMP, cv::CHAIN_APPROX_SIMPLE, {u0, v0});
  return contours;
}

}  // namespace

void draw_outline(cv::Mat& canvas, const DamageMap& map, const Damage& damage, int line, cv::Point origin,
                  double scale) {
  const cv::Scalar dark{20, 20, 20};
  auto contours = outlines(map, damage);
  for (auto& contour : contours) {
    for (cv::Point& point : contour) {
      point = {cvRound((point.x - origin.x + 0.5) * scale - 0.5), cvRound((point.y - origin.y + 0.5) * scale - 0.5)};
    }
  }
  cv::polylines(canvas, contours, true, dark, line + std::max(2, line), cv::LINE_AA);
  cv::polylines(canvas, contours, true, colour_of(damage), line, cv::LINE_AA);
}

}  // namespace roadstereo::io
