#pragma once

#include <vector>

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// A line of vertical offsets, pixels: constant + per_column·x + per_row·v at column x of the right image and row v.
struct RowOffset {
  double constant_px = 0;
  double per_column = 0;
  double per_row = 0;

  double at(double x, double v) const { return constant_px + per_column * x + per_row * v; }
};

/// Vertical offset v_right − v_left of the matched points of a pair.
struct RowAlignment {
  double median_px = 0;     ///< median vertical offset, pixels
  double sigma_px = 0;      ///< robust standard deviation (1.4826 · MAD), pixels
  int points = 0;           ///< matched points; with fewer than 20 the offset is unknown
  double fit_sigma_px = 0;  ///< the same around `fit`, pixels
  RowOffset fit;            ///< robust fit; without slopes where none is significant, 0 where the offset is not

  static constexpr int min_points = 20;
  static constexpr double max_fit_sigma_px = 1;  ///< beyond it they contradict each other, as on repeating texture
  /// Whether the points tell the offset.
  bool known() const { return points >= min_points && fit_sigma_px <= max_fit_sigma_px; }
};

/// A matched point: (u, v) in the left image, (u + du, v + dv) in the right one.
struct RowSample {
  double u = 0, v = 0;
  double du = 0, dv = 0;  ///< pixels; dv to a fraction of one
};

/// Matches the points that `measure_row_alignment` takes the median of: at most 135, spread over the image, none of
/// them where the left image is masked (`mask` not 0; empty: nowhere).
std::vector<RowSample> sample_row_alignment(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                            int threads = 0, ImageView<const std::uint8_t> mask = {});

/// Measures the vertical offset of a rectified pair by affine Lucas-Kanade alignment of image blocks, up to about 2 %
/// of the image height.
RowAlignment measure_row_alignment(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                   int threads = 0, ImageView<const std::uint8_t> mask = {});

}  // namespace roadstereo
#pragma GCC visibility pop
