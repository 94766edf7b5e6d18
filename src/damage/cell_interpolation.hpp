#pragma once

#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// The two cells that a pixel lies between, along one axis.
struct Between {
  int first = 0, second = 0;  ///< one and the same in the middle of a cell and beyond the border
  float share = 0;            ///< of the second, 0 … 1
};

/// Cells are squares of `factor` pixels; there are `count` of them.
Between between(int pixel, int factor, int count);

/// A map of cells between their middles, at pixel (u, v): bilinear, continued at the border. NaN where a neighbour is.
float at_pixel(const Image<float>& cells, int factor, int u, int v);

/// The same for whole rows of pixels, best read from the top down: each row of cells is spread out but once.
class PixelRows {
 public:
  /// The map must live as long as this. `width` is that of the picture, in pixels.
  PixelRows(const Image<float>& cells, int factor, int width);

  /// Writes the `width` values of row v.
  void read(int v, float* values);

 private:
  /// A row of cells, interpolated along the row only.
  struct Spread {
    int row = -1;
    std::vector<float> values;
  };
  void spread(int row, Spread& into) const;

  const Image<float>& cells_;
  int factor_;
  std::vector<Between> columns_;  ///< of every pixel of a row
  Spread above_, below_;
};

}  // namespace roadstereo
