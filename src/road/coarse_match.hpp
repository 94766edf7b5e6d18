#pragma once

#include "road/plane_fit.hpp"
#include "roadstereo/image.hpp"

// Block matching by normalised cross-correlation on the downsampled pair, with left-right and distinctness checks.

namespace roadstereo {

/// Correspondences over the whole image and the whole range of disparities, from a dense search along the rows of the
/// shrunk pair: only those that are textured, distinct, and found from both sides. Coordinates and disparities are
/// those of the full-size image, good to about `factor`/4 pixels.
ScratchVector<DisparityPoint> match_coarsely(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                             int factor, double max_disparity_px, int threads);

}  // namespace roadstereo
