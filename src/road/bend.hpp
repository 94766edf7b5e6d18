#pragma once

#include <cmath>

#include "roadstereo/disparity_plane.hpp"
#include "roadstereo/host_device.hpp"

// Bend of a road across its direction, as camber leaves it in the residuals of a plane fit: residual = bend · s², where
// s runs along the lines of equal disparity. u, v and s are deviations from the weighted means.
namespace roadstereo {

/// Unit vector along the lines of equal disparity.
struct LevelDirection {
  double u, v;

  ROADSTEREO_HD explicit LevelDirection(const DisparityPlane& plane) : u(1), v(0) {
    const double length = sqrt(plane.a1 * plane.a1 + plane.a2 * plane.a2);
    if (!(length > 0)) return;
    u = plane.a1 / length;
    v = -plane.a2 / length;
  }
  ROADSTEREO_HD double along(double du, double dv) const { return u * du + v * dv; }
};

/// Weighted sums over the points of a fit; p is s².
struct BendSums {
  double n, uu, uv, vv;
  double p, pu, pv, pp;
  double r, ru, rv, rp;  ///< of the residuals
};

/// Least-squares bend with the part of s² that a plane explains taken off, in pixels of disparity per pixel².
struct BendFit {
  double p0 = 0, pu = 0, pv = 0;  ///< the plane's part of s²
  double normal = 0;              ///< weighted sum of squares of the rest
  double bend = 0;

  ROADSTEREO_HD explicit BendFit(const BendSums& sums) {
    const double determinant = sums.uu * sums.vv - sums.uv * sums.uv;
    if (!(sums.n > 0 && determinant > 0)) return;
    p0 = sums.p / sums.n;
    pu = (sums.vv * sums.pu - sums.uv * sums.pv) / determinant;
    pv = (sums.uu * sums.pv - sums.uv * sums.pu) / determinant;
    normal = sums.pp - p0 * sums.p - pu * sums.pu - pv * sums.pv;
    if (normal > 0) bend = (sums.rp - p0 * sums.r - pu * sums.ru - pv * sums.rv) / normal;
  }
  /// What a plane does not explain of s² at a point.
  ROADSTEREO_HD double rest(double s, double du, double dv) const { return s * s - p0 - pu * du - pv * dv; }
};

}  // namespace roadstereo
