#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "map/build_map.hpp"
#include "roadstereo/map_changes.hpp"

namespace roadstereo::cli {

/// A change of a damage from one day to a later one. Records are without their footprints.
struct DayChange {
  DamageChangeKind kind = DamageChangeKind::appeared;
  std::size_t before_day = 0, after_day = 0;  ///< indices of `BuiltMap::days`
  std::optional<RoadDamageRecord> before, after;
  Measurement height_change_m;
};

/// Compares every day with the day before it that measured the same place. `damages`: of each day.
std::vector<DayChange> changes_between_days(const BuiltMap& built,
                                            const std::vector<std::vector<RoadDamageRecord>>& damages);

/// Returns changes.csv.
std::string changes_csv(const BuiltMap& built, const std::vector<DayChange>& changes);
/// Returns `changes` of map.json.
nlohmann::ordered_json changes_json(const BuiltMap& built, const std::vector<DayChange>& changes);
/// Returns one line per change.
std::string changes_text(const BuiltMap& built, const std::vector<DayChange>& changes);

}  // namespace roadstereo::cli
