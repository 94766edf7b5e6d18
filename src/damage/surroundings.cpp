#include "roadstereo/surroundings.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo {

PixelBox surroundings(const DamageMap& map, const Damage& damage, double share, int least_px) {
  const auto& [u0, v0, u1, v1] = damage.box_px;
  const auto margin = [&](int side) { return std::max(least_px, static_cast<int>(std::lround(share * side))); };
  const int across = margin(u1 - u0 + 1), down = margin(v1 - v0 + 1);
  const int right = map.ids.width() - 1, bottom = map.ids.height() - 1;
  return {std::clamp(u0 - across, 0, right), std::clamp(v0 - down, 0, bottom), std::clamp(u1 + across, 0, right),
          std::clamp(v1 + down, 0, bottom)};
}

}  // namespace roadstereo
