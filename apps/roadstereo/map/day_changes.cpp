#include "map/day_changes.hpp"

#include <fmt/core.h>

#include <limits>

#include "io/csv.hpp"
#include "map/map_values.hpp"

namespace roadstereo::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Records whose place no day between two others measures.
std::vector<RoadDamageRecord> unseen_between(const BuiltMap& built, const std::vector<RoadDamageRecord>& records,
                                             std::size_t before, std::size_t after) {
  std::vector<RoadDamageRecord> unseen;
  for (const RoadDamageRecord& record : records) {
    bool seen = false;
    for (std::size_t day = before + 1; day < after; ++day) {
      seen = seen || measures(built.days[day].map, record.best.footprint);
    }
    if (!seen) unseen.push_back(record);
  }
  return unseen;
}

std::optional<RoadDamageRecord> without_footprint(const std::vector<RoadDamageRecord>& records,
                                                  const std::optional<std::size_t>& index) {
  if (!index) return std::nullopt;
  RoadDamageRecord record = records[*index];
  record.best.footprint.clear();
  return record;
}

/// The later record, or of a repaired damage the last one.
const RoadDamageRecord& last_of(const DayChange& change) {
  return change.after ? *change.after : *change.before;
}

/// A figure of a record that may be absent.
Measurement figure(const std::optional<RoadDamageRecord>& record, Measurement RoadDamageRecord::*member) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  return record ? (*record).*member : Measurement{unknown, unknown};
}

std::string mm_text(const std::optional<RoadDamageRecord>& record) {
  constexpr double mm = 1000;
  if (!record) return "–";
  return fmt::format("{:.1f} ± {:.1f} mm, {:.3f} ± {:.3f} m²", mm * record->max_depth_m.value,
                     mm * record->max_depth_m.std_error, record->area_m2.value, record->area_m2.std_error);
}

}  // namespace

std::vector<DayChange> changes_between_days(const BuiltMap& built,
                                            const std::vector<std::vector<RoadDamageRecord>>& damages) {
  std::vector<DayChange> changes;
  for (std::size_t after = 1; after < built.days.size(); ++after) {
    for (std::size_t before = after; before-- > 0;) {
      const auto earlier = unseen_between(built, damages[before], before, after);
      const auto later = unseen_between(built, damages[after], before, after);
      for (const DamageChange& change : compare_damage(earlier, built.days[before].map, later, built.days[after].map)) {
        changes.push_back({change.kind, before, after, without_footprint(earlier, change.before),
                           without_footprint(later, change.after), change.height_change_m});
      }
    }
  }
  return changes;
}

std::string changes_csv(const BuiltMap& built, const std::vector<DayChange>& changes) {
  std::string text =
      "change,kind,x_m,y_m,max_depth_before_m,max_depth_before_stderr_m,max_depth_after_m,max_depth_after_stderr_m,"
      "area_before_m2,area_before_stderr_m2,area_after_m2,area_after_stderr_m2,height_change_m,height_change_stderr_m,"
      "before_day,after_day\r\n";
  for (const DayChange& change : changes) {
    const RoadDamageRecord& last = last_of(change);
    const std::array<double, 2> at = in_crs(built, last.best.at_m);
    io::CsvLine line;
    line.add(name_of(change.kind)).add(name_of(last.best.damage.kind)).add(at[0], 3).add(at[1], 3);
    for (const auto member : {&RoadDamageRecord::max_depth_m, &RoadDamageRecord::area_m2}) {
      line.add(figure(change.before, member), 6).add(figure(change.after, member), 6);
    }
    line.add(change.height_change_m, 6).add(built.days[change.before_day].name);
    text += line.add(built.days[change.after_day].name).end();
  }
  return text;
}

Json changes_json(const BuiltMap& built, const std::vector<DayChange>& changes) {
  Json list = Json::array();
  for (const DayChange& change : changes) {
    const RoadDamageRecord& last = last_of(change);
    const std::array<double, 2> at = in_crs(built, last.best.at_m);
    list.push_back({{"change", name_of(change.kind)},
                    {"kind", name_of(last.best.damage.kind)},
                    {"x_m", json_number(at[0])},
                    {"y_m", json_number(at[1])},
                    {"before_day", built.days[change.before_day].name},
                    {"after_day", built.days[change.after_day].name},
                    {"max_depth_before_m", measurement_json(figure(change.before, &RoadDamageRecord::max_depth_m))},
                    {"max_depth_after_m", measurement_json(figure(change.after, &RoadDamageRecord::max_depth_m))},
                    {"area_before_m2", measurement_json(figure(change.before, &RoadDamageRecord::area_m2))},
                    {"area_after_m2", measurement_json(figure(change.after, &RoadDamageRecord::area_m2))},
                    {"height_change_m", measurement_json(change.height_change_m)}});
  }
  return list;
}

std::string changes_text(const BuiltMap& built, const std::vector<DayChange>& changes) {
  if (built.days.size() < 2) return {};
  std::string text = fmt::format("  days      {}, {} changes\n", built.days.size(), changes.size());
  for (const DayChange& change : changes) {
    const RoadDamageRecord& last = last_of(change);
    const std::array<double, 2> at = in_crs(built, last.best.at_m);
    text += fmt::format("    {:<8} {:<10} at {:.2f}, {:.2f} m: {} on {}, {} on {}\n", name_of(change.kind),
                        name_of(last.best.damage.kind), at[0], at[1], mm_text(change.before),
                        built.days[change.before_day].name, mm_text(change.after), built.days[change.after_day].name);
  }
  return text;
}

}  // namespace roadstereo::cli
