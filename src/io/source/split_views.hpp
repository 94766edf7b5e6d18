#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "roadstereo/io/frame_source.hpp"

namespace roadstereo::io {

/// Returns the layout of an image of that size: `wanted`, or for `automatic` the layout whose views have an aspect
/// ratio of 5:4 … 2.4:1. Throws Error that starts with `source` if there is none, or if the size is odd.
StereoLayout find_layout(const std::string& source, int width, int height, StereoLayout wanted);

/// Converts a matrix of 8 or 16 bits to a frame: 1 channel grey, 3 BGR, 4 BGRA. Throws Error naming `source`.
Frame picture_frame(const std::string& source, const cv::Mat& picture);

/// Copies the halves of the image to the views of the pair. `layout` is a result of `find_layout`.
void split_views(const std::string& source, const cv::Mat& picture, StereoLayout layout, SourcePair& pair);

}  // namespace roadstereo::io
