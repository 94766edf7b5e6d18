#pragma once

namespace roadstereo {

/// The ten sums over a disparity map, as they are added up: weights, coordinates from an origin, and products.
struct RawSums {
  double n = 0, u = 0, v = 0, d = 0;
  double uu = 0, uv = 0, vv = 0, ud = 0, vd = 0, dd = 0;
};

}  // namespace roadstereo
