#pragma once

#include "roadstereo/image.hpp"

namespace roadstereo {

/// How well the rows of a pair agree: the offset v_right − v_left of matched points.
struct RowAlignment {
  double median_px = 0;  ///< median vertical offset, pixels
  double sigma_px = 0;   ///< robust standard deviation (1.4826 · MAD), pixels
  int points = 0;        ///< matched points; with fewer than 20 nothing is known

  bool known() const { return points >= 20; }
};

/// Measures the vertical offset of a pair that should be rectified, up to about 2 % of the image height.
RowAlignment measure_row_alignment(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                   int threads = 0);

}  // namespace roadstereo
