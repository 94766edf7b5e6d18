#pragma once

#include "roadstereo/host_device.hpp"

namespace roadstereo {

/// The ten sums over a disparity map, as they are added up: weights, coordinates from an origin, and products.
struct RawSums {
  double n = 0, u = 0, v = 0, d = 0;
  double uu = 0, uv = 0, vv = 0, ud = 0, vd = 0, dd = 0;
};

/// Weight and means of points of disparity space, and sums of products of deviations from the means.
struct DeviationSums {
  double n, mean_u, mean_v, mean_d;
  double uu, uv, vv, ud, vd, dd;
};

/// Of sums about an origin.
ROADSTEREO_HD inline DeviationSums deviations_of(const RawSums& s, double origin_u, double origin_v) {
  const double u = s.u / s.n, v = s.v / s.n, d = s.d / s.n;
  return {s.n,
          origin_u + u,
          origin_v + v,
          d,
          s.uu - s.u * u,
          s.uv - s.u * v,
          s.vv - s.v * v,
          s.ud - s.u * d,
          s.vd - s.v * d,
          s.dd - s.d * d};
}

}  // namespace roadstereo
