#pragma once

#include "road/masked_blocks.hpp"
#include "road/plane_fit.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// What the search around a supposed road found.
struct PlaneMatches {
  ScratchVector<DisparityPoint> points =
      scratch_vector<DisparityPoint>();  ///< sub-pixel correspondences within the range
  ScratchVector<float> correlations =
      scratch_vector<float>();  ///< highest of each sample that matches within a pixel of the plane, however low
  int tried = 0;                ///< textured samples of the road that both views see
  int min_points = 0;           ///< fewer of them are no evidence of a plane
};

/// Looks for correspondences within `range_px` of the supposed road, at most plane_match_max_range, on a grid of about
/// `places` places: each block follows the slant of the plane, so that it matches sharply. `masked` blocks are left
/// out.
PlaneMatches match_along_plane(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                               const DisparityPlane& plane, int range_px, int places, int threads,
                               const MaskedBlocks& masked = {});

/// The same for cells of 5×5 samples, by the sum of their correlations: where noise or defocus leave no single block
/// distinct, a cell of them still is.
PlaneMatches match_cells_along_plane(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                                     const DisparityPlane& plane, int range_px, int places, int threads,
                                     const MaskedBlocks& masked = {});

}  // namespace roadstereo
