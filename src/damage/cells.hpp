#pragma once

#include <algorithm>
#include <array>

#include "core/map_value.hpp"
#include "roadstereo/damage.hpp"

namespace roadstereo {

/// The transformed map downsampled to square cells of `factor`×`factor` pixels: each cell is the mean of its valid
/// pixels. Segmentation works on cells.
struct Cells {
  int factor = 1;       ///< side of a cell, pixels
  int image_width = 0;  ///< pixels
  int image_height = 0;
  int smoothing_px = 0;  ///< standard deviation of all averaging in the map, pixels
  Image<float> value;    ///< ℓ', pixels; NaN where fewer than half of the pixels are valid

  int width() const { return value.width(); }
  int height() const { return value.height(); }
  /// Image coordinate of the centre of cell i, for columns and rows.
  double middle(int i) const { return i * factor + 0.5 * (factor - 1); }
  /// Pixel (u, v) at the centre of a cell, inside the image even if the border clips the cell.
  std::array<int, 2> centre(int i, int j) const {
    return {std::min(static_cast<int>(middle(i)), image_width - 1),
            std::min(static_cast<int>(middle(j)), image_height - 1)};
  }
};

/// Side of a cell, pixels, so that an image has at most some 300 000 cells.
int cell_factor(int width, int height);

/// Downsample a W×H map to cells. Pixels whose `sigma` exceeds 1 px count as invalid, except for the error of smoothing
/// over `smoothing_px` in hollows that are narrower; `sigma` is W×H or empty. Throws Error when no pixel of the map is
/// valid, or all valid pixels have one value.
Cells make_cells(ImageView<const float> transformed, ImageView<const float> sigma, int smoothing_px, int factor,
                 int threads);

}  // namespace roadstereo
