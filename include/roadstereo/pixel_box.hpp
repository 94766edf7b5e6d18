#pragma once

#include "roadstereo/damage.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Rectangle of pixels; the last column u1 and row v1 are inside.
struct PixelBox {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;

  int width() const { return u1 - u0 + 1; }
  int height() const { return v1 - v0 + 1; }
};

/// Bounding box of the damage with a margin of `share` of each side, at least `min_px`, clipped to the map.
PixelBox box_with_margin(const DamageMap& map, const Damage& damage, double share, int min_px);

}  // namespace roadstereo
#pragma GCC visibility pop
