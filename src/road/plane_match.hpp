#pragma once

#include "road/plane_fit.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// What the search around a supposed road found.
struct PlaneMatches {
  ScratchVector<DisparityPoint> points =
      scratch_vector<DisparityPoint>();  ///< sub-pixel correspondences within the range
  int tried = 0;                         ///< textured places of the road that both views see
};

/// Looks for correspondences within `range_px` of the supposed road, on a grid of about `places` places: each block
/// follows the slant of the plane, so that it matches sharply.
PlaneMatches match_along_plane(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                               const DisparityPlane& plane, int range_px, int places, int threads);

}  // namespace roadstereo
