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
  MapDamage best;           ///< the finding in the map if there is one, else the best sighting; its footprint is that
                            ///< of all
  Measurement max_depth_m;  ///< fused from the sightings, as are the next three
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

/// Joins the sightings of one damage over frames and passes, and the finding in the map: damages of one kind whose
/// footprints overlap by a fifth of the smaller one. Values of sightings that no border cuts and that are confident
/// (all, where none is) are averaged with inverse variances, scaled to the median value, as weights. Only the part of
/// their errors that differs from frame to frame shrinks, by the number of independent views, n / `view_factor`. A
/// damage that is cut in all sightings has the values of `best`. The joint confidence of n frames, including frames
/// without a sighting, is that of one frame √(n / `view_factor`) times as significant; frames that see the place from
/// afar weigh less, by pixels and noise. Returns the damages with at
/// least `min_confidence` whose depth is resolved: it exceeds three standard errors, or
/// DamageEvidence::is_depth_resolved holds for a sighting or for the finding in the map. Deepest first. Throws Error
/// when an option is out of range or a damage has no metric values.
std::vector<RoadDamageRecord> join_damage(std::span<const DamageSighting> sightings, std::span<const MapDamage> in_map,
                                          const RoadMap& map, const DamageOptions& options);

}  // namespace roadstereo
#pragma GCC visibility pop
