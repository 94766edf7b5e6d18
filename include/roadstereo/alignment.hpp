#pragma once

#include <vector>

#include "roadstereo/image.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Linear model of the vertical offset, pixels: constant + per_column·x + per_row·v at column x of the right image and
/// row v.
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
  RowOffset fit;            ///< robust fit: a plane if one of its slopes is significant, else a constant if that is,
                            ///< else 0

  static constexpr int min_points = 20;
  static constexpr double max_fit_sigma_px = 1;  ///< with a larger one the points contradict each other, as on
                                                 ///< repeating texture
  /// Whether there are enough points, and they agree: else the offset is unknown.
  bool known() const { return points >= min_points && fit_sigma_px <= max_fit_sigma_px; }
};

/// A matched point: (u, v) in the left image, (u + du, v + dv) in the right one.
struct RowSample {
  double u = 0, v = 0;
  double du = 0, dv = 0;  ///< pixels; dv to a fraction of one
};

/// Matches the points from which `measure_row_alignment` determines the offset: at most 135, spread over the image.
/// Pixels of the left image where `mask` (W×H, or empty) is not 0 and a black or repeated border are left out. Throws
/// Error when the sizes differ.
std::vector<RowSample> sample_row_alignment(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                            int threads = 0, ImageView<const std::uint8_t> mask = {});

/// Measures the vertical offset of a rectified pair by affine Lucas-Kanade alignment of image blocks, up to about 2 %
/// of the image height. `mask` and errors as for `sample_row_alignment`.
RowAlignment measure_row_alignment(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                   int threads = 0, ImageView<const std::uint8_t> mask = {});

}  // namespace roadstereo
#pragma GCC visibility pop
