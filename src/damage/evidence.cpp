#include <algorithm>
#include <cmath>

#include "roadstereo/damage.hpp"

namespace roadstereo {

namespace {

/// Log of the ratio of two normal densities of the surface share, of damage and of what one camera alone sees, at most
/// 0: the agreement of the pictures shows a surface, not that it is damage. Measured on regions of at least 400 pixels
/// in the pictures with rain, snow and dead pixels of `evaluate faults`: 0.88 ± 0.07 and 0.47 ± 0.13, here with one
/// deviation.
double surface_log_odds(double share) {
  constexpr double of_damage = 0.88, of_artefacts = 0.47, deviation = 0.10;
  if (std::isnan(share)) return 0;
  const double middle = 0.5 * (of_damage + of_artefacts);
  return std::min(0.0, (of_damage - of_artefacts) * (share - middle) / (deviation * deviation));
}

}  // namespace

double DamageEvidence::confidence() const {
  // Fitted to labelled maps, labelled pairs, rendered roads and drives over intact roads (docs/method.md, Damage).
  constexpr double intercept = -9.8;
  constexpr double per_log_significance = 2.15;
  constexpr double per_road_share = 4.4;
  constexpr double per_border_share = -9.5;
  constexpr double max_significance = 100;  // more does not tell a pothole from a kerb
  const double log_odds = intercept + per_log_significance * std::log(std::clamp(significance, 1.0, max_significance)) +
                          per_road_share * road_share + per_border_share * border_share;
  return 1 / (1 + std::exp(-(log_odds + surface_log_odds(surface_share))));
}

}  // namespace roadstereo
