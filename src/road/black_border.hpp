#pragma once

#include <cstdint>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Finds what lies outside of the picture: what is black from a side of the image on, as rectification, letterboxes and
/// pillarboxes leave it. Its edge is at the same place in both images and would match there, at a disparity of 0.
/// `outside`: 255 there and where `mask` (empty, or of the same size) is not 0, else 0. Returns false, with `outside`
/// undefined, where less than one in 50 pixels of its sides, or in 500 of the image, is black.
bool find_black_border(ImageView<const std::int16_t> grey, ImageView<const std::uint8_t> mask,
                       Image<std::uint8_t>& outside);

}  // namespace roadstereo
