#pragma once

#include <algorithm>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Two taps of a linear interpolation between the centres of cells, along one axis.
struct LinearTaps {
  int first = 0, second = 0;  ///< cells; equal at the centre of a cell and beyond the outermost centres
  float weight = 0;           ///< of the second cell, 0 … 1
};

/// Taps of a pixel. Cells are squares of `factor` pixels; there are `count` of them along the axis.
inline LinearTaps linear_taps(int pixel, int factor, int count) {
  const float half = 0.5F * static_cast<float>(factor - 1);
  const float x =
      std::clamp((static_cast<float>(pixel) - half) / static_cast<float>(factor), 0.0F, static_cast<float>(count - 1));
  const int first = static_cast<int>(x);
  const float weight = x - static_cast<float>(first);
  return {first, weight > 0 ? first + 1 : first, weight};
}

/// Interpolate a map of cells bilinearly at pixel column u between its rows. Beyond the outermost centres the border is
/// replicated. NaN if a tap is NaN.
inline float interpolate_bilinear(const Image<float>& cells, int factor, int u, const LinearTaps& rows) {
  const auto [left, right, s] = linear_taps(u, factor, cells.width());
  const auto [above, below, t] = rows;
  return (1 - t) * ((1 - s) * cells(left, above) + s * cells(right, above)) +
         t * ((1 - s) * cells(left, below) + s * cells(right, below));
}

/// Bilinear upsampling of a map of cells to pixels, row by row. Fastest from top to bottom: each row of cells is then
/// interpolated along the row only once.
class RowUpsampler {
 public:
  /// The map must outlive this. `width` is the width of the image in pixels.
  RowUpsampler(const Image<float>& cells, int factor, int width);

  /// Write the `width` values of pixel row v.
  void read(int v, float* values);

 private:
  /// A row of cells, interpolated along the row.
  struct InterpolatedRow {
    int row = -1;
    std::vector<float> values;
  };
  void interpolate_row(int row, InterpolatedRow& result) const;

  const Image<float>& cells_;
  int factor_;
  int width_;
  InterpolatedRow above_, below_;
};

}  // namespace roadstereo
