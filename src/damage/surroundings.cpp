#include "roadstereo/surroundings.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo {

PixelBox surroundings(const DamageMap& map, const Damage& damage, double share, int least_px) {
  const auto& [u0, v0, u1, v1] = damage.box_px;
  const int longer = std::max(u1 - u0, v1 - v0) + 1;
  const int margin = std::max(least_px, static_cast<int>(std::lround(share * longer)));
  const int right = map.ids.width() - 1, bottom = map.ids.height() - 1;
  return {std::clamp(u0 - margin, 0, right), std::clamp(v0 - margin, 0, bottom), std::clamp(u1 + margin, 0, right),
          std::clamp(v1 + margin, 0, bottom)};
}

}  // namespace roadstereo
