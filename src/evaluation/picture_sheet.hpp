#pragma once

#include <string>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::io {

/// One picture of a sheet with the line above it.
struct SheetCell {
  std::string title;
  Frame picture;
};

/// Rows of pictures, 8 bit, every one scaled to `cell_width` pixels, with their titles. Throws Error when there is no
/// picture.
Frame picture_sheet(const std::vector<std::vector<SheetCell>>& rows, int cell_width);

}  // namespace roadstereo::io
