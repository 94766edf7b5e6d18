#pragma once

#include <cstdint>

#include "roadstereo/image_view.hpp"

namespace roadstereo {

/// Measures the excess of the steps between blocks of 8×8 pixels (JPEG) over those beside them, relative, wherever the
/// grid of the blocks lies: in a picture that was cropped after its compression it begins anywhere. Of the eight places
/// along the rows, and along the columns, that with the largest median excess counts, if it is beyond chance in both
/// directions; else 0.
double block_grid_excess(ImageView<const std::int16_t> image);

}  // namespace roadstereo
