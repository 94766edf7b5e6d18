#include "roadstereo/pixel_box.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo {

PixelBox box_with_margin(const DamageMap& map, const Damage& damage, double share, int min_px) {
  const auto& [u0, v0, u1, v1] = damage.box_px;
  const auto margin = [&](int side) { return std::max(min_px, static_cast<int>(std::lround(share * side))); };
  const int margin_u = margin(u1 - u0 + 1), margin_v = margin(v1 - v0 + 1);
  const int last_u = map.ids.width() - 1, last_v = map.ids.height() - 1;
  return {std::clamp(u0 - margin_u, 0, last_u), std::clamp(v0 - margin_v, 0, last_v),
          std::clamp(u1 + margin_u, 0, last_u), std::clamp(v1 + margin_v, 0, last_v)};
}

}  // namespace roadstereo
