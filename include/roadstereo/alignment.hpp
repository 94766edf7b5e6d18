#pragma once

#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Vertical offset v_right − v_left of the matched points of a pair.
struct RowAlignment {
  double median_px = 0;  ///< median vertical offset, pixels
  double sigma_px = 0;   ///< robust standard deviation (1.4826 · MAD), pixels
  int points = 0;        ///< matched points; with fewer than 20 the offset is unknown

  bool known() const { return points >= 20; }
};

/// A matched point: (u, v) in the left image, (u + du, v + dv) in the right one.
struct RowSample {
  double u = 0, v = 0;
  double du = 0, dv = 0;  ///< pixels; dv to a fraction of one
};

/// Matches the points that `measure_row_alignment` takes the median of: at most 135, spread over the image.
std::vector<RowSample> sample_row_alignment(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                            int threads = 0);

/// Measures the vertical offset of a rectified pair by affine Lucas-Kanade alignment of image blocks, up to about 2 %
/// of the image height.
RowAlignment measure_row_alignment(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                   int threads = 0);

}  // namespace roadstereo
