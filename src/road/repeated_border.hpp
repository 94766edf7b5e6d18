#pragma once

#include <cstdint>

#include "roadstereo/image_view.hpp"

namespace roadstereo {

/// Number of rows and columns at the sides of an image that repeat the picture beside them: its last row or column
/// (BORDER_REPLICATE of OpenCV, video coding), or its mirror image (BORDER_REFLECT).
struct RepeatedBorder {
  int top = 0, bottom = 0, left = 0, right = 0;

  bool empty() const { return top == 0 && bottom == 0 && left == 0 && right == 0; }
};

/// Finds the repeated border of an image, at least 3 lines and at most an eighth of its rows or columns on a side.
/// Noise never repeats a line: those of a border differ less than the lines of this picture do, where it has texture.
/// Without texture there is nothing to tell a border by, and what repeats once more inside is the picture's pattern.
RepeatedBorder find_repeated_border(ImageView<const std::int16_t> grey);

}  // namespace roadstereo
