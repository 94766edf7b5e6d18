#pragma once

#include <cstdint>

#include "roadstereo/image_view.hpp"

namespace roadstereo {

/// Measures the noise that a sensor adds to whole columns or whole rows, the sum of both variances, where `road` (W×H)
/// is not 0; squared units of the grey levels. Texture is not mistaken for it: the columns (rows) under a second
/// difference along the rows (columns) are averaged over two sets of bands, 16 pixels wide, and what both have in
/// common is counted, by robust standard deviations of their sum and difference. NaN with fewer than 40 such averages
/// in one of the directions.
double stripe_variance(ImageView<const std::int16_t> image, ImageView<const std::uint8_t> road);

}  // namespace roadstereo
