#include "io/geo/geo_columns.hpp"

#include <cmath>
#include <numbers>

#include "io/damage_columns.hpp"

namespace roadstereo::io {
namespace {

GeoValue number(double value) {
  if (!std::isfinite(value)) return std::monostate{};
  return value;
}

/// A column of damages.csv as a property; its type is taken from a damage with all values known.
GeoColumn<GeoDamage> damage_property(const DamageColumn& column) {
  struct TypeOf {
    GeoType operator()(std::int64_t) const { return GeoType::whole; }
    GeoType operator()(double) const { return GeoType::number; }
    GeoType operator()(bool) const { return GeoType::flag; }
    GeoType operator()(const std::string&) const { return GeoType::text; }
    GeoType operator()(std::monostate) const { return GeoType::text; }
  };
  Damage known;
  known.metrics.emplace();
  return {column.name, std::visit(TypeOf{}, column.value(known)), [value = column.value](const GeoDamage& damage) {
            return std::visit([](const auto& each) -> GeoValue { return each; }, value(damage.damage));
          }};
}

using FrameColumn = GeoColumn<GeoFrame>;
using DamageProperty = GeoColumn<GeoDamage>;

}  // namespace

GeoValue geo_time(double time_s) {
  const std::optional<UtcTime> time = utc_time(time_s);
  if (!time) return std::monostate{};
  return *time;
}

const std::vector<FrameColumn>& geo_frame_columns() {
  static const std::vector<FrameColumn> columns = {
      {"frame", GeoType::whole, [](const GeoFrame& f) { return GeoValue(f.index); }},
      {"name", GeoType::text, [](const GeoFrame& f) { return GeoValue(f.name); }},
      {"time_utc", GeoType::time, [](const GeoFrame& f) { return geo_time(f.time_s); }},
      {"time_s", GeoType::number, [](const GeoFrame& f) { return number(f.time_s); }},
      {"status", GeoType::text, [](const GeoFrame& f) { return GeoValue(f.status); }},
      {"damages", GeoType::whole, [](const GeoFrame& f) { return GeoValue(std::int64_t{f.damages}); }},
      {"heading_deg", GeoType::number,
       [](const GeoFrame& f) { return number(f.position.value_or(GeoPosition{}).heading_deg); }},
      {"alt_m", GeoType::number, [](const GeoFrame& f) { return number(f.position.value_or(GeoPosition{}).alt_m); }},
      {"roll_deg", GeoType::number, [](const GeoFrame& f) { return number(f.roll_rad * 180 / std::numbers::pi); }},
      {"height_m", GeoType::number, [](const GeoFrame& f) { return number(f.height_m); }},
      {"sigma_d_px", GeoType::number, [](const GeoFrame& f) { return number(f.sigma_d_px); }},
      {"valid_share", GeoType::number, [](const GeoFrame& f) { return number(f.valid_share); }}};
  return columns;
}

const std::vector<DamageProperty>& geo_damage_columns() {
  static const std::vector<DamageProperty> columns = [] {
    std::vector<DamageProperty> all = {
        {"frame", GeoType::whole, [](const GeoDamage& d) { return GeoValue(d.frame); }},
        {"frame_name", GeoType::text, [](const GeoDamage& d) { return GeoValue(d.frame_name); }},
        {"time_utc", GeoType::time, [](const GeoDamage& d) { return geo_time(d.time_s); }}};
    for (const DamageColumn& column : damage_columns()) all.push_back(damage_property(column));
    return all;
  }();
  return columns;
}

}  // namespace roadstereo::io
