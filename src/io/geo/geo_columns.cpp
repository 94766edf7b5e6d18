#include "io/geo/geo_columns.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/degrees.hpp"
#include "io/csv.hpp"
#include "io/damage_columns.hpp"

namespace roadstereo::io {
namespace {

GeoValue number(double value) {
  if (!std::isfinite(value)) return std::monostate{};
  return value;
}

struct TypeOf {
  GeoType operator()(std::int64_t) const { return GeoType::whole; }
  GeoType operator()(double) const { return GeoType::number; }
  GeoType operator()(bool) const { return GeoType::flag; }
  GeoType operator()(const std::string&) const { return GeoType::text; }
  GeoType operator()(std::monostate) const { return GeoType::text; }
};

/// A column of the damage tables as a property of a row that has a damage; its type is taken from a damage with all
/// values known.
template <class Row>
GeoColumn<Row> damage_property(const DamageColumn& column, const Damage Row::*member) {
  Damage known;
  known.metrics.emplace();
  DamageEvidence& evidence = known.evidence;
  evidence.surface_significance = evidence.range_vote = evidence.specular_excess = evidence.texture_share = 0;
  evidence.pixel_significance = evidence.likely_wall_slope = evidence.extent = 0;
  return {column.name, std::visit(TypeOf{}, column.value(known)), [value = column.value, member](const Row& row) {
            return std::visit([](const auto& each) -> GeoValue { return each; }, value(row.*member));
          }};
}

GeoShape point_of(const std::optional<GeoPosition>& position) {
  if (!position) return {};
  return {{position->lon_deg, position->lat_deg, position->alt_m}};
}

/// A polygon across ±180° has no geometry.
GeoShape polygon_of(const std::vector<std::array<double, 2>>& corners) {
  GeoShape shape;
  for (const auto& [lon, lat] : corners) {
    if (std::abs(lon - corners.front()[0]) > 180) return {};
    shape.push_back({lon, lat, std::nan("")});
  }
  return shape;
}

using FrameColumn = GeoColumn<GeoFrame>;
using RecordColumn = GeoColumn<RoadDamage>;

std::vector<FrameColumn> frame_columns() {
  return {
      {"frame", GeoType::whole, [](const GeoFrame& f) { return GeoValue(f.index); }},
      {"name", GeoType::text, [](const GeoFrame& f) { return GeoValue(f.name); }},
      {"time_utc", GeoType::time, [](const GeoFrame& f) { return geo_time(f.time_s); }},
      {"time_s", GeoType::number, [](const GeoFrame& f) { return number(f.time_s); }},
      {"status", GeoType::text, [](const GeoFrame& f) { return GeoValue(f.status); }},
      {"damages", GeoType::whole, [](const GeoFrame& f) { return f.damages ? GeoValue(*f.damages) : GeoValue(); }},
      {"station_m", GeoType::number, [](const GeoFrame& f) { return number(f.station_m); }},
      {"heading_deg", GeoType::number,
       [](const GeoFrame& f) { return number(f.position.value_or(GeoPosition{}).heading_deg); }},
      {"alt_m", GeoType::number, [](const GeoFrame& f) { return number(f.position.value_or(GeoPosition{}).alt_m); }},
      {"roll_deg", GeoType::number, [](const GeoFrame& f) { return number(to_degrees(f.roll_rad)); }},
      {"height_m", GeoType::number, [](const GeoFrame& f) { return number(f.height_m); }},
      {"sigma_d_px", GeoType::number, [](const GeoFrame& f) { return number(f.sigma_d_px); }},
      {"valid_share", GeoType::number, [](const GeoFrame& f) { return number(f.valid_share); }}};
}

std::vector<GeoColumn<GeoSighting>> sighting_columns() {
  std::vector<GeoColumn<GeoSighting>> all = {
      {"road_damage", GeoType::whole, [](const GeoSighting& s) { return GeoValue(s.road_damage); }},
      {"frame", GeoType::whole, [](const GeoSighting& s) { return GeoValue(s.frame); }},
      {"frame_name", GeoType::text, [](const GeoSighting& s) { return GeoValue(s.frame_name); }},
      {"time_utc", GeoType::time, [](const GeoSighting& s) { return geo_time(s.time_s); }}};
  for (const DamageColumn& column : damage_columns()) all.push_back(damage_property(column, &GeoSighting::damage));
  return all;
}

/// Columns of damages.csv.
std::vector<RecordColumn> first_columns() {
  std::vector<RecordColumn> columns = {
      {"id", GeoType::whole, [](const RoadDamage& d) { return GeoValue(d.id); }},
      {"lat_deg", GeoType::number,
       [](const RoadDamage& d) { return d.position ? number(d.position->lat_deg) : GeoValue(); }},
      {"lon_deg", GeoType::number,
       [](const RoadDamage& d) { return d.position ? number(d.position->lon_deg) : GeoValue(); }}};
  const std::vector<DamageColumn>& all = damage_columns();
  for (const char* name : {"distress", "severity", "max_depth_m", "max_depth_m_stderr", "area_m2", "area_m2_stderr",
                           "quantity", "unit", "confidence", "cut_by_border"}) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [name](const DamageColumn& column) { return std::string(column.name) == name; });
    columns.push_back(damage_property(*found, &RoadDamage::best));
  }
  columns.push_back({"picture", GeoType::text,
                     [](const RoadDamage& d) { return d.picture.empty() ? GeoValue() : GeoValue(d.picture); }});
  return columns;
}

std::vector<RecordColumn> record_columns() {
  std::vector<RecordColumn> all = first_columns();
  const std::vector<RecordColumn> sightings = {
      {"sightings", GeoType::whole, [](const RoadDamage& d) { return GeoValue(d.sightings); }},
      {"first_frame", GeoType::whole, [](const RoadDamage& d) { return GeoValue(d.first_frame); }},
      {"last_frame", GeoType::whole, [](const RoadDamage& d) { return GeoValue(d.last_frame); }},
      {"frame", GeoType::whole, [](const RoadDamage& d) { return GeoValue(d.frame); }},
      {"frame_name", GeoType::text, [](const RoadDamage& d) { return GeoValue(d.frame_name); }},
      {"time_utc", GeoType::time, [](const RoadDamage& d) { return geo_time(d.time_s); }},
      {"station_m", GeoType::number, [](const RoadDamage& d) { return number(d.station_m); }}};
  all.insert(all.end(), sightings.begin(), sightings.end());
  for (const DamageColumn& column : damage_columns()) {
    const bool known =
        std::any_of(all.begin(), all.end(), [&](const RecordColumn& other) { return other.name == column.name; });
    if (!known) all.push_back(damage_property(column, &RoadDamage::best));
  }
  return all;
}

struct AddCell {
  CsvLine& line;
  void operator()(std::monostate) const { line.add_nothing(); }
  void operator()(const UtcTime& time) const { line.add(iso_text(time)); }
  template <class Value>
  void operator()(const Value& value) const {
    line.add(value);
  }
};

}  // namespace

GeoValue geo_time(double time_s) {
  const std::optional<UtcTime> time = utc_time(time_s);
  if (!time) return std::monostate{};
  return *time;
}

const GeoLayer<GeoFrame>& frame_layer() {
  static const GeoLayer<GeoFrame> layer{"frames", false, frame_columns(),
                                        [](const GeoFrame& frame) { return point_of(frame.position); }};
  return layer;
}

const GeoLayer<GeoFrame>& footprint_layer() {
  static const GeoLayer<GeoFrame> layer{"footprints", true, frame_columns(),
                                        [](const GeoFrame& frame) { return polygon_of(frame.footprint_deg); }};
  return layer;
}

const GeoLayer<GeoSighting>& sighting_layer() {
  static const GeoLayer<GeoSighting> layer{"sightings", false, sighting_columns(),
                                           [](const GeoSighting& sighting) { return point_of(sighting.position); }};
  return layer;
}

const GeoLayer<RoadDamage>& damage_layer(bool candidates) {
  const auto shape = [](const RoadDamage& damage) { return polygon_of(damage.outline_deg); };
  static const GeoLayer<RoadDamage> damages{"damages", true, record_columns(), shape};
  static const GeoLayer<RoadDamage> others{"candidates", true, record_columns(), shape};
  return candidates ? others : damages;
}

std::vector<RoadDamage> damage_rows(const GeoLayers& layers, bool candidates) {
  std::vector<RoadDamage> rows;
  std::copy_if(layers.damages.begin(), layers.damages.end(), std::back_inserter(rows),
               [candidates](const RoadDamage& damage) { return damage.candidate == candidates; });
  return rows;
}

std::string road_damages_csv_names() {
  CsvLine line;
  const auto& columns = damage_layer(false).columns;
  for (std::size_t i = 0; i < damage_csv_columns; ++i) line.add(columns[i].name);
  return line.end();
}

std::string road_damages_csv_rows(std::span<const RoadDamage> damages) {
  std::string rows;
  const auto& columns = damage_layer(false).columns;
  for (const RoadDamage& damage : damages) {
    CsvLine line;
    for (std::size_t i = 0; i < damage_csv_columns; ++i) std::visit(AddCell{line}, columns[i].value(damage));
    rows += line.end();
  }
  return rows;
}

}  // namespace roadstereo::io
