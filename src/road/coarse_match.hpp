#pragma once

#include "road/disparity_evidence.hpp"
#include "road/plane_fit.hpp"
#include "roadstereo/image.hpp"

// Block matching by normalised cross-correlation on the downsampled pair, with left-right and distinctness checks.

namespace roadstereo {

/// What a dense search along the rows of the downsampled pair found, over the whole image and the whole range.
struct CoarseMatches {
  /// Only those that are textured, distinct, and found from both sides. Coordinates and disparities are those of the
  /// full-size image, good to about `factor`/4 pixels.
  ScratchVector<DisparityPoint> points = scratch_vector<DisparityPoint>();
  DisparityEvidence evidence;  ///< of the downsampled image
  int factor = 1;              ///< by which the pair was downsampled
  int first_row = 0;           ///< row of the downsampled image where the first cell begins
  int width = 0;               ///< of the downsampled image, pixels
  int height = 0;              ///< of the downsampled image, pixels

  double pixels() const { return static_cast<double>(width) * height; }
};

/// Pixels where `mask` (W×H, or empty) is not 0 take no part: no block of the left image contains them.
CoarseMatches match_coarsely(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right, int factor,
                             double max_disparity_px, int threads, ImageView<const std::uint8_t> mask = {});

}  // namespace roadstereo
