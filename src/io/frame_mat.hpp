#pragma once

#include <opencv2/core.hpp>

#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// The frame's own samples as OpenCV sees them, nothing copied. Read only: OpenCV has no const matrix.
cv::Mat mat_over(const FrameView& frame);

/// The map's own values as OpenCV sees them, nothing copied. Read only.
cv::Mat mat_over(ImageView<const float> map);

/// Copies a matrix of 8 or 16 bits with 1, 3 or 4 channels into a frame of that order.
Frame frame_from(const cv::Mat& mat, ChannelOrder order);

/// A copy of the frame as 8-bit BGR for drawing; 16-bit samples are divided by `white_level` and multiplied
/// by 255.
cv::Mat to_bgr(const FrameView& frame, double white_level);

}  // namespace roadstereo::io
