#include <algorithm>
#include <cmath>

#include "roadstereo/damage.hpp"

namespace roadstereo {

double DamageEvidence::confidence() const {
  // Fitted to labelled maps, labelled pairs, rendered roads and drives over intact roads (docs/method.md, Damage).
  constexpr double intercept = -10.5;
  constexpr double per_log_significance = 2.2;
  constexpr double per_steepness = 0.6;
  constexpr double per_road_share = 2.6;
  constexpr double per_border_share = -7.3;
  constexpr double max_steepness = 5;
  const double log_odds = intercept + per_log_significance * std::log(std::max(1.0, significance)) +
                          per_steepness * std::min(steepness, max_steepness) + per_road_share * road_share +
                          per_border_share * border_share;
  return 1 / (1 + std::exp(-log_odds));
}

}  // namespace roadstereo
