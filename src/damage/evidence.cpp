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

/// Log-odds of damage whose outline lies on the border to a share, with a wall of a slope. The border may cut a
/// pothole, whose share is 0.4 if a disc is halved, hardly along more of its rim; and what is gentle there is the
/// relief of the road rather than a wall. Elsewhere that counts little, since depressions are gentle, and noise is as
/// steep as walls. A protrusion has no slope: what is gentle may be a bump or the road, what is steep what stands at
/// its side.
double wall_log_odds(double border_share, double slope) {
  constexpr double per_square = -18, per_fourth_power = -35;  // of the border share
  constexpr double per_log_slope = 0.5, per_square_and_log_slope = 16;
  constexpr double min_slope = 0.05, even_slope = 0.3;
  const double square = border_share * border_share;
  if (std::isnan(slope)) return per_square * square;
  const double steeper = std::log(std::clamp(slope, min_slope, 1.0) / even_slope);
  return per_log_slope * std::min(0.0, steeper) +
         square * (per_square + per_fourth_power * square + per_square_and_log_slope * steeper);
}

}  // namespace

double DamageEvidence::confidence() const {
  // Fitted to labelled maps, labelled pairs, rendered roads and drives over intact roads (docs/method.md, Damage).
  constexpr double intercept = -9.8;
  constexpr double per_log_significance = 2.15;
  constexpr double per_road_share = 4.4;
  constexpr double per_unseen_share = -9.5;
  constexpr double max_significance = 100;  // more does not tell a pothole from a kerb
  const double log_odds = intercept + per_log_significance * std::log(std::clamp(significance, 1.0, max_significance)) +
                          per_road_share * road_share + per_unseen_share * unseen_share;
  return probability_of(log_odds + wall_log_odds(border_share, likely_wall_slope) +
                        surface_log_odds(surface_significance));
}

}  // namespace roadstereo
