#pragma once

#include "roadstereo/damage.hpp"

namespace roadstereo {

/// A rectangle of pixels, last column and row included.
struct PixelBox {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;

  int width() const { return u1 - u0 + 1; }
  int height() const { return v1 - v0 + 1; }
};

/// The damage's box and a margin of `share` of each side, at least `least_px`, inside the map.
PixelBox surroundings(const DamageMap& map, const Damage& damage, double share, int least_px);

}  // namespace roadstereo
