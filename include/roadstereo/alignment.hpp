#pragma once

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Vertical offset v_right − v_left of the matched points of a pair.
struct RowAlignment {
  double median_px = 0;  ///< median vertical offset, pixels
  double sigma_px = 0;   ///< robust standard deviation (1.4826 · MAD), pixels
  int points = 0;        ///< matched points; with fewer than 20 the offset is unknown

  bool known() const { return points >= 20; }
};

/// Measures the vertical offset of a rectified pair by affine Lucas-Kanade alignment of image blocks, up to about 2 %
/// of the image height.
RowAlignment measure_row_alignment(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                   int threads = 0);

}  // namespace roadstereo
