#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace roadstereo::io {

/// A line of text in DejaVu Sans, rendered by FreeType: opacity, 0 … 255.
struct TextLine {
  cv::Mat cover;     ///< CV_8UC1; empty if nothing is to be seen
  cv::Point origin;  ///< of `cover`, relative to the left end of the base line
  int width = 0;     ///< of the line, pixels
};

/// Render UTF-8 text whose capitals are `height` pixels high. Characters that the font lacks are shown as "?".
TextLine render_line(const std::string& text, int height);

}  // namespace roadstereo::io
