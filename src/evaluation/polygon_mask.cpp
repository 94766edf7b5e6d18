#include "evaluation/polygon_mask.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace roadstereo {

Image<std::uint8_t> polygon_mask(const std::vector<Polygon>& polygons, int width, int height) {
  constexpr int fraction_bits = 8;
  constexpr double scale = 1 << fraction_bits;
  std::vector<std::vector<cv::Point>> corners;
  for (const Polygon& polygon : polygons) {
    corners.emplace_back();
    for (const auto& [u, v] : polygon) {
      corners.back().emplace_back(static_cast<int>(std::lround(scale * u)), static_cast<int>(std::lround(scale * v)));
    }
  }
  Image<std::uint8_t> mask(width, height, 0);
  cv::Mat pixels(height, width, CV_8UC1, mask.row(0));
  cv::fillPoly(pixels, corners, cv::Scalar(255), cv::LINE_8, fraction_bits);
  return mask;
}

}  // namespace roadstereo
