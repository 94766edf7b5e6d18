#include "evaluation/peer_maps.hpp"

#include <cmath>
#include <limits>

namespace roadstereo::io {

cv::Mat grey_bytes(const GreyImage& grey) {
  cv::Mat bytes(grey.height(), grey.width(), CV_8U);
  for (int v = 0; v < grey.height(); ++v) {
    for (int u = 0; u < grey.width(); ++u)
      bytes.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(std::lround(grey(u, v) / double{grey_scale}));
  }
  return bytes;
}

cv::Mat depths_m(const Image<float>& disparity, const StereoCalibration& calibration) {
  cv::Mat depths(disparity.height(), disparity.width(), CV_32F);
  for (int v = 0; v < disparity.height(); ++v) {
    for (int u = 0; u < disparity.width(); ++u) {
      const double d = double{disparity(u, v)} + calibration.disparity_offset_px;
      depths.at<float>(v, u) = d >= min_peer_disparity_px
                                   ? static_cast<float>(calibration.focal_px * calibration.baseline_m / d)
                                   : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return depths;
}

}  // namespace roadstereo::io
