#pragma once

#include "roadstereo/image.hpp"

namespace roadstereo {

/// The image at 1 / factor of its size; each pixel is the mean of factor × factor. The rest at the right and bottom is
/// dropped. Pixel (x, y) of it has its centre at ((x + ½)·factor − ½, …) of the image.
void shrink(ImageView<const std::int16_t> image, int factor, GreyImage& small);
GreyImage shrink(ImageView<const std::int16_t> image, int factor);

/// Full-size coordinate of a coordinate of the shrunk image.
inline double unshrink(double x, int factor) {
  return (x + 0.5) * factor - 0.5;
}

}  // namespace roadstereo
