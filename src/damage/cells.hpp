#pragma once

#include "roadstereo/damage.hpp"

namespace roadstereo {

/// The maps in square cells of a few pixels: what segmentation looks at. A cell knows the mean of its valid pixels.
struct Cells {
  int factor = 1;       ///< pixels along the side of a cell
  int image_width = 0;  ///< pixels
  int image_height = 0;
  Image<float> value;  ///< ℓ', pixels; NaN where fewer than half of the pixels are valid

  int width() const { return value.width(); }
  int height() const { return value.height(); }
  /// Image coordinate of the middle of cell i, along u as along v.
  double middle(int i) const { return i * factor + 0.5 * (factor - 1); }
  /// Cell that pixel u (or v) lies in.
  int cell_of(int pixel) const { return pixel / factor; }
};

/// The side of a cell that keeps a frame below some 300 000 cells.
int cell_factor(int width, int height);

/// A pixel whose `sigma` (may be empty) is above a pixel says nothing about the relief: it counts as invalid.
/// Throws Error when no pixel of the map is valid, or all have one value.
Cells make_cells(ImageView<const float> transformed, ImageView<const float> sigma, int factor, int threads);

}  // namespace roadstereo
