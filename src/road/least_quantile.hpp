#pragma once

#include <cstdint>

#include "road/random_number.hpp"
#include "roadstereo/disparity_plane.hpp"
#include "roadstereo/host_device.hpp"

// Least quantile of squares (LQS, Rousseeuw 1984), where the robust fit of a map starts, on the host and on the device:
// the plane that a share of the points is nearest to. A pavement or a bank of snow beside the road may hold more than
// half of the points, and lie within a pixel or two of it. A fit from a plane between both has both in its window, and
// stays there. Since nothing lies below a road but its damage and a verge, the share is a quarter of the points, and as
// many again as lie below the plane.
namespace roadstereo {

/// Planes that are tried: through three random points each. Where a third of the points is road, 11 of them are its.
inline constexpr int tried_planes = 300;
/// Random points by which they are compared, 13 for each lane of a warp.
inline constexpr int compared_points = 416;

/// Whether a disparity can be of the road of which an estimate has another one there: off by no more than a fifth,
/// which is a fifth of the camera's height, or by what an estimate in noise is. The rest, house fronts and trees, may
/// be most of the map.
ROADSTEREO_HD inline bool can_be_of_road(double disparity, double of_estimate) {
  constexpr double max_height_share = 0.2, max_error_px = 4;
  const double share_px = max_height_share * of_estimate;
  const double reach_px = share_px > max_error_px ? share_px : max_error_px, off = disparity - of_estimate;
  return off >= -reach_px && off <= reach_px;
}

/// Index, of `count` points, of the k-th that planes are compared by. It may be missing.
ROADSTEREO_HD inline int compared_point(int k, int count) {
  return static_cast<int>(random_number(static_cast<std::uint64_t>(k), static_cast<std::uint64_t>(count)));
}
/// Index of the point that is corner 0 … 2 of the k-th plane. It may be missing; then there is no such plane.
ROADSTEREO_HD inline int corner_point(int k, int corner, int count) {
  return compared_point(compared_points + 3 * k + corner, count);
}
/// What a point near the plane counts, by the sign of its residual. One below it no longer counts against the plane,
/// too.
ROADSTEREO_HD inline int quantile_weight(bool below) {
  return below ? 2 : 1;
}
/// What the points near the plane must count together: those within the quantile.
ROADSTEREO_HD inline int quantile_of(int points, int below) {
  return points / 4 + below + 1;
}

/// Coordinates are taken relative to a. False when the points lie on one line of the image.
ROADSTEREO_HD inline bool plane_through(const double (&a)[3], const double (&b)[3], const double (&c)[3],
                                        DisparityPlane& plane) {
  const double bu = b[0] - a[0], bv = b[1] - a[1], bd = b[2] - a[2];
  const double cu = c[0] - a[0], cv = c[1] - a[1], cd = c[2] - a[2];
  const double determinant = bu * cv - bv * cu;
  if (determinant < 1e-6 && determinant > -1e-6) return false;
  plane.a2 = (bd * cv - bv * cd) / determinant;
  plane.a1 = (bu * cd - bd * cu) / determinant;
  plane.a0 = a[2] - plane.a1 * a[1] - plane.a2 * a[0];
  return true;
}

/// A plane, and the quantile of the magnitudes of its residuals, pixels.
struct QuantilePlane {
  DisparityPlane plane;
  double quantile_px;
};

}  // namespace roadstereo
