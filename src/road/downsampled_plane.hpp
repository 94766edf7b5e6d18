#pragma once

#include "core/full_resolution.hpp"
#include "roadstereo/disparity_plane.hpp"

namespace roadstereo {

/// A plane of the full-size image in the coordinates and pixels of the image downsampled by `factor`.
ROADSTEREO_HD inline DisparityPlane downsample_plane(const DisparityPlane& plane, int factor) {
  const double centre = to_full_resolution(0, factor);
  return {plane.disparity(centre, centre) / factor, plane.a1, plane.a2};
}

/// The reverse: u = factor·u' + centre, d = factor·d'.
inline DisparityPlane plane_to_full_size(const DisparityPlane& plane, int factor) {
  const double centre = to_full_resolution(0, factor);
  return {factor * plane.a0 - (plane.a1 + plane.a2) * centre, plane.a1, plane.a2};
}

}  // namespace roadstereo
