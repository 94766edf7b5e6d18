#include "damage/clutter.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "damage/candidates.hpp"

namespace roadstereo {

void add_clutter(std::vector<Damage>& damages) {
  const auto noise_share = [](const Damage& damage) {
    return damage.confidence < min_candidate_confidence ? 0 : 1 - damage.confidence;
  };
  std::array<double, 2> noise{};  // expected number of regions, of each kind
  for (const Damage& damage : damages) noise[static_cast<std::size_t>(damage.kind)] += noise_share(damage);
  for (Damage& damage : damages) {
    std::array<double, 2> of_others = noise;
    double& of_kind = of_others[static_cast<std::size_t>(damage.kind)];
    of_kind = std::max(0.0, of_kind - noise_share(damage));
    damage.evidence.clutter = 2 * std::min(of_others[0], of_others[1]);
    damage.confidence = damage.evidence.confidence();
  }
}

}  // namespace roadstereo
