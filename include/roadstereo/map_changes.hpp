#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "roadstereo/map_inventory.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// What became of a damage between two days.
enum class DamageChangeKind {
  appeared,  ///< new
  grown,     ///< deeper or larger
  reduced,   ///< shallower or smaller, such as partly filled
  repaired   ///< gone
};
const char* name_of(DamageChangeKind kind);  ///< "new", "grown", "reduced", "repaired"

/// A change of a damage beyond two standard errors.
struct DamageChange {
  DamageChangeKind kind = DamageChangeKind::appeared;
  std::optional<std::size_t> before;  ///< index of the earlier record; absent if it is new
  std::optional<std::size_t> after;   ///< index of the later record; absent if it is repaired
  /// Mean change of the heights in the footprint, against those of the band of 0.1 m around it, metres, with the
  /// standard error of one cell in it, for errors of neighbours are alike
  Measurement height_change_m;
};

/// Returns whether the map measures at least half of a footprint.
bool measures(const RoadMap& map, const MapCells& footprint);

/// Compares the damages of two maps of one road in the same axes. Records are of one damage if they are of one kind and
/// their footprints overlap by a fifth of the smaller one. They have changed if depth or area differ by more than two
/// standard errors of the difference, or the heights in the footprint have moved by more than two of theirs; what is
/// listed only once, if the heights have moved so: what only one of the lists has, but both maps alike, is no change.
/// Places that one of the maps does not measure are left out.
std::vector<DamageChange> compare_damage(std::span<const RoadDamageRecord> before, const RoadMap& map_before,
                                         std::span<const RoadDamageRecord> after, const RoadMap& map_after);

}  // namespace roadstereo
#pragma GCC visibility pop
