#pragma once

#include <opencv2/core.hpp>

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Wraps the samples of a frame without copying. Do not write to it: OpenCV has no const matrix.
cv::Mat mat_over(const FrameView& frame);

/// Wraps the values of a map without copying. Do not write to it.
cv::Mat mat_over(ImageView<const float> map);

/// Copies a matrix of 8 or 16 bits with 1, 3 or 4 channels to a frame of that channel order.
Frame frame_from(const cv::Mat& mat, ChannelOrder order);

/// Converts a frame to 8-bit BGR for drawing; `white_level` of 16-bit samples as in to_grey.
cv::Mat to_bgr(const FrameView& frame, double white_level);

}  // namespace roadstereo::io
#pragma GCC visibility pop
