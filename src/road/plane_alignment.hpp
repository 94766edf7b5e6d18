#pragma once

#include <cstdint>

#include "roadstereo/disparity_plane.hpp"
#include "roadstereo/image.hpp"

namespace roadstereo {

/// Aligns the right image with the left one along a plane that is about right (Lucas and Kanade, for the parameters of
/// the plane) in the pair downsampled by `factor` and smoothed: every block that correlates along the plane counts with
/// what its texture tells, so that noise or defocus that leave no block distinct average out. Returns `plane` where too
/// little correlates. `mask` (not 0 masked) may be empty.
DisparityPlane align_plane(ImageView<const std::int16_t> left, ImageView<const std::int16_t> right,
                           ImageView<const std::uint8_t> mask, const DisparityPlane& plane, int factor, bool with_roll,
                           int threads);

}  // namespace roadstereo
