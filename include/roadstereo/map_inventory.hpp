#pragma once

#include <array>
#include <span>
#include <vector>

#include "roadstereo/map_damage.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// One damage in one frame of a pass.
struct DamageSighting {
  int pass = 0;   ///< recording, from 0
  int frame = 0;  ///< of the recording, from 0
  MapDamage found;
};

/// One damage of the road, from all frames and passes that show it.
struct RoadDamageRecord {
  int id = 0;               ///< from 1, deepest first
  MapDamage best;           ///< of the map if it is found there, else the best sighting; footprint of all
  Measurement max_depth_m;  ///< fused, as the next three
  Measurement mean_depth_m;
  Measurement area_m2;
  Measurement volume_m3;
  SeverityProbabilities severity_probabilities;
  Severity severity = Severity::unknown;
  double confidence = 0;  ///< that this is damage, 0 … 1
  int sightings = 0;      ///< frames that show it
  int passes = 0;         ///< recordings that show it
  int views = 0;          ///< frames that measure its place
  bool found_in_map = false;
};

/// Joins the sightings of one damage over frames and passes, and what is found in the map: footprints of one kind that
/// overlap by a fifth of the smaller one. Figures of sightings that no border cuts are weighted with their inverse
/// variances; only the part of their errors that differs from frame to frame shrinks, by the number of independent
/// views, n / `view_factor`. What no sighting shows whole is measured in the map. Confidences of n frames, a frame
/// without a sighting included, are those of one that is √(n / `view_factor`) times as significant. Returns the damages
/// of at least `min_confidence`, and deeper than three of their standard errors, deepest first. Throws Error when one
/// has no metric values.
std::vector<RoadDamageRecord> join_damage(std::span<const DamageSighting> sightings, std::span<const MapDamage> in_map,
                                          const RoadMap& map, const DamageOptions& options);

}  // namespace roadstereo
#pragma GCC visibility pop
