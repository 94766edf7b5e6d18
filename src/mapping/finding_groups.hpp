#pragma once

#include <span>
#include <vector>

#include "mapping/footprints.hpp"
#include "roadstereo/map_inventory.hpp"

namespace roadstereo {

/// Findings of one damage.
struct FindingGroup {
  DamageKind kind = DamageKind::depression;
  MapCells footprint;  ///< of the confident ones, or of the first
  CellBounds bounds;   ///< of the footprint
  const MapDamage* in_map = nullptr;
  std::vector<const DamageSighting*> sightings;
};

/// Groups findings of one kind whose footprints overlap: the map first, since its noise is least, then whole sightings
/// before cut ones; the most confident first. Groups that have grown together are one.
std::vector<FindingGroup> group_findings(std::span<const DamageSighting> sightings, std::span<const MapDamage> in_map,
                                         double min_confidence);

}  // namespace roadstereo
