#include <algorithm>
#include <cmath>

#include "roadstereo/damage.hpp"

namespace roadstereo {

double DamageEvidence::confidence() const {
  // Fitted to labelled maps, labelled pairs, rendered roads and drives over intact roads (docs/method.md, Damage).
  constexpr double intercept = -9.8;
  constexpr double per_log_significance = 2.15;
  constexpr double per_road_share = 4.4;
  constexpr double per_border_share = -9.5;
  constexpr double max_significance = 100;  // more does not tell a pothole from a kerb
  const double log_odds = intercept + per_log_significance * std::log(std::clamp(significance, 1.0, max_significance)) +
                          per_road_share * road_share + per_border_share * border_share;
  return 1 / (1 + std::exp(-log_odds));
}

}  // namespace roadstereo
