#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "roadstereo/map_inventory.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// How a damage changed between two days.
enum class DamageChangeKind {
  appeared,  ///< new
  grown,     ///< deeper or larger
  reduced,   ///< shallower or smaller, such as partly filled
  repaired   ///< gone
};
const char* name_of(DamageChangeKind kind);  ///< "new", "grown", "reduced", "repaired"

/// A change of a damage by more than two standard errors.
struct DamageChange {
  DamageChangeKind kind = DamageChangeKind::appeared;
  std::optional<std::size_t> before;  ///< index of the earlier record; absent if it is new
  std::optional<std::size_t> after;   ///< index of the later record; absent if it is repaired
  /// Mean change of the heights in the footprint relative to that in the band of 0.1 m around it, metres. Its standard
  /// error is that of a single cell, since the errors of neighbouring cells are correlated
  Measurement height_change_m;
};

/// Returns whether the map measures at least half of a footprint.
bool measures(const RoadMap& map, const MapCells& footprint);

/// Returns whether a later map knows better than an earlier record: it has a record of the same damage, or heights in
/// the footprint by which it is gone rather than still there, filled by more than half of its mean depth.
bool is_superseded(const RoadDamageRecord& before, const RoadMap& map_before, std::span<const RoadDamageRecord> after,
                   const RoadMap& map_after);

/// Compares the damages of two maps of one road in the same axes. Two records belong to one damage if they are of the
/// same kind and their footprints overlap by a fifth of the smaller one. The damage has changed if its depth or area
/// differs by more than two standard errors of the difference, or if the heights in the footprint have changed by more
/// than two standard errors. A damage that only one list contains is new or repaired only if the heights have changed
/// by that much; if both maps show the same heights, there is no change. Places without heights in one of the maps are
/// left out.
std::vector<DamageChange> compare_damage(std::span<const RoadDamageRecord> before, const RoadMap& map_before,
                                         std::span<const RoadDamageRecord> after, const RoadMap& map_after);

}  // namespace roadstereo
#pragma GCC visibility pop
