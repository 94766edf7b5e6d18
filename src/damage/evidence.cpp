#include <algorithm>
#include <cmath>

#include "core/log_odds.hpp"
#include "roadstereo/damage.hpp"

namespace roadstereo {

namespace {

/// Log-odds of damage against what one camera alone sees. They count against it in full and for it by little: the
/// agreement of the pictures shows a surface, not that it is damage. Fitted to regions of rendered roads with rain,
/// snow and dead pixels (docs/method.md). A map alone, whose pictures are unknown, has neither.
double surface_log_odds(double significance) {
  constexpr double per_standard_error = 4.7, even_odds = 1.85, max_log_odds = 0.5;
  return std::isnan(significance) ? 0 : std::min(max_log_odds, per_standard_error * (significance - even_odds));
}

}  // namespace

double DamageEvidence::confidence() const {
  // Fitted to labelled maps, labelled pairs, rendered roads and drives over intact roads (docs/method.md, Damage).
  constexpr double intercept = -9.8;
  constexpr double per_log_significance = 2.15;
  constexpr double per_road_share = 4.4;
  constexpr double per_unseen_share = -9.5;
  constexpr double per_squared_border_share = -18;  // the border may cut a pothole, hardly along half of its rim
  constexpr double max_significance = 100;          // more does not tell a pothole from a kerb
  const double log_odds = intercept + per_log_significance * std::log(std::clamp(significance, 1.0, max_significance)) +
                          per_road_share * road_share + per_unseen_share * unseen_share +
                          per_squared_border_share * border_share * border_share;
  return probability_of(log_odds + surface_log_odds(surface_significance));
}

}  // namespace roadstereo
