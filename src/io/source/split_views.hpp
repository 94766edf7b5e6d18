#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::io {

/// How a picture of that size holds both views: `wanted`, or for `automatic` the one layout whose views have the shape
/// of a camera's, 5:4 … 2.4:1. Throws Error that begins with `source` when no layout has, or the picture cannot be
/// halved. Never `automatic`.
StereoLayout find_layout(const std::string& source, int width, int height, StereoLayout wanted);

/// A picture as a frame: one channel is grey, three are BGR, four BGRA; 8 or 16 bits. Throws Error naming `source`.
Frame picture_frame(const std::string& source, const cv::Mat& picture);

/// Copies the halves of the picture into the pair's views. The layout fits the picture, see `find_layout`.
void split_views(const std::string& source, const cv::Mat& picture, StereoLayout layout, SourcePair& pair);

}  // namespace roadstereo::io
