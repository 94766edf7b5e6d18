#pragma once

#include <string>

namespace roadstereo::cli {

struct ImageSize {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
};

/// Parses "640x360", the argument of --size. Throws Error if it is not two positive numbers.
ImageSize parse_image_size(const std::string& text);

}  // namespace roadstereo::cli
