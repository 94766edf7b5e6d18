#pragma once

#include <opencv2/core.hpp>

#include "roadstereo/calibration.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// Disparities below this are too far for peers, pixels.
inline constexpr double min_peer_disparity_px = 2;

/// The grey levels, 8 bit.
cv::Mat grey_bytes(const GreyImage& grey);

/// Depths, metres; NaN where the disparity is invalid or too small.
cv::Mat depths_m(const Image<float>& disparity, const StereoCalibration& calibration);

}  // namespace roadstereo::io
