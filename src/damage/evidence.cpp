#include <algorithm>
#include <cmath>

#include "core/log_odds.hpp"
#include "roadstereo/damage.hpp"

namespace roadstereo {

namespace {

/// Logarithm of the slope of a wall over that of one that may be either.
double log_steepness(double slope) {
  constexpr double min_slope = 0.05, even_slope = 0.3;
  return std::log(std::clamp(slope, min_slope, 1.0) / even_slope);
}

/// Significance of the surface at which damage and artefacts that only one camera sees are equally likely, for a region
/// of `windows` independent windows. Of artefacts it is 0.6 in the median, since their disparities were chosen for the
/// agreement that is measured here; but they seldom cover more than a few windows.
double even_surface_significance(double windows) {
  constexpr double of_chosen_disparities = 0.6, of_one_window = 1.85;
  return of_chosen_disparities + (of_one_window - of_chosen_disparities) / std::sqrt(windows);
}

/// Log-odds of damage against these artefacts. For a protrusion, whose slope is unknown, agreement of the images adds
/// little: it proves a surface, but objects on the road or beside it have one, too. A hollow with a wall that the
/// images confirm is almost always damage; a gentle one may be relief of the road. Fitted to regions of rendered roads
/// with rain, snow and dead pixels, and to hollows put into streets (docs/damage.md). `gentle`: share to which gentle
/// walls count. A map alone, whose pictures are unknown, has none.
double surface_log_odds(double significance, double windows, double slope, double gentle) {
  constexpr double per_standard_error = 4.7, max_of_protrusion = 0.5;  // of one window
  constexpr double per_standard_error_of_hollow = 1, max_standard_errors = 2;
  if (std::isnan(significance)) return 0;
  const double lacking = significance - even_surface_significance(windows);
  if (lacking < 0) return per_standard_error * std::sqrt(windows) * lacking;
  const double above = std::max(0.0, significance - even_surface_significance(1));
  if (std::isnan(slope)) return std::min(max_of_protrusion, per_standard_error * above);
  return per_standard_error_of_hollow * std::min(above, max_standard_errors) +
         gentle * std::min(above, 1.0) * std::min(0.0, log_steepness(slope));
}

/// Log-odds of damage where disparities that were not searched fit the pictures as well or better: matches by chance
/// have votes of 0 and less, damage in the faintest texture 0.35 and more. A higher vote says nothing more.
double range_log_odds(double vote) {
  constexpr double per_vote = 20, even_odds = 0.3;
  return vote < even_odds ? per_vote * (vote - even_odds) : 0;
}

/// Log-odds of damage, given the number of their own standard errors by which at least a quarter of the pixels lie off
/// the road. The noise of the intact road alone does not show how accurate a region with less texture is.
double pixel_log_odds(double significance) {
  constexpr double per_log_significance = 1.5, even_odds = 5;
  if (std::isnan(significance)) return 0;
  return per_log_significance * std::min(0.0, std::log(std::max(significance, 1.0) / even_odds));
}

/// Log-odds of damage where one image is brighter than the other and than the road: glint. Damage, dry or wet, has 0.02
/// and less.
double specular_log_odds(double excess) {
  constexpr double per_excess = -50, even_odds = 0.03;
  return excess > even_odds ? per_excess * (excess - even_odds) : 0;  // 0 if unknown
}

/// Log-odds of damage for a protrusion whose surroundings look like itself and not like the road: part of a verge, an
/// island or a pavement. Of bumps, humps and debris on rendered roads 0.15 is the largest share.
double texture_log_odds(double share) {
  constexpr double per_share = -15, even_odds = 0.25;
  return share > even_odds ? per_share * (share - even_odds) : 0;  // 0 if unknown
}

/// Log-odds for a region wider than the reach of the surface, which may be the shape of the road, a strip or a pavement
/// beside it.
double extent_log_odds(double extent) {
  constexpr double per_log_extent = -5.6;
  return extent > 1 ? per_log_extent * std::log(extent) : 0;  // 0 if unknown
}

/// Log-odds of damage whose outline lies on the border to a share, with a wall of a slope. The border may cut a
/// pothole, whose share is 0.4 if a disc is halved, hardly along more of its rim; and what is gentle there is the
/// relief of the road rather than a wall. Elsewhere that counts little, since depressions are gentle, and noise is as
/// steep as walls. A protrusion has no slope: what is gentle may be a bump or the road, what is steep what stands at
/// its side.
double wall_log_odds(double border_share, double slope) {
  constexpr double per_square = -18, per_fourth_power = -35;  // of the border share
  constexpr double per_log_slope = 0.5, per_square_and_log_slope = 16;
  const double square = border_share * border_share;
  if (std::isnan(slope)) return per_square * square;
  const double steeper = log_steepness(slope);
  return per_log_slope * std::min(0.0, steeper) +
         square * (per_square + per_fourth_power * square + per_square_and_log_slope * steeper);
}

/// Log-odds of damage among regions that are noise: the odds of one more grow in proportion to their number. One of
/// each kind is not unusual on a rough road.
double clutter_log_odds(double clutter) {
  constexpr double usual = 2;
  return -std::log1p(std::max(0.0, clutter - usual));
}

/// Share to which gentle walls, extent and the border say nothing against damage: a rut is gentle and runs on beyond
/// the picture.
double rut_share(double significance) {
  constexpr double half_share = 10;
  const double square = significance * significance;
  return square / (square + half_share * half_share);
}

}  // namespace

double DamageEvidence::confidence() const {
  // Fitted to labelled maps, labelled pairs, rendered roads and drives over intact roads (docs/damage.md, Confidence).
  constexpr double intercept = -9.8;
  constexpr double per_log_significance = 2.15;
  constexpr double per_road_share = 4.4;
  constexpr double per_unseen_share = -9.5;
  constexpr double max_significance = 100;  // more does not tell a pothole from a kerb
  const double log_odds = intercept + per_log_significance * std::log(std::clamp(significance, 1.0, max_significance)) +
                          per_road_share * road_share + per_unseen_share * unseen_share;
  const double gentle = 1 - rut_share(rut_significance);
  const double windows = contrast_sigmas > 0 ? std::pow(significance / contrast_sigmas, 2) : 1;
  return probability_of(log_odds + surface_log_odds(surface_significance, windows, likely_wall_slope, gentle) +
                        gentle * (wall_log_odds(border_share, likely_wall_slope) + extent_log_odds(extent)) +
                        range_log_odds(range_vote) + pixel_log_odds(pixel_significance) +
                        specular_log_odds(specular_excess) + texture_log_odds(texture_share) +
                        clutter_log_odds(clutter));
}

}  // namespace roadstereo
