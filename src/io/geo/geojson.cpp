#include <cmath>
#include <nlohmann/json.hpp>

#include "io/geo/geo_columns.hpp"

namespace roadstereo::io {
namespace {

using Json = nlohmann::ordered_json;

struct ToJson {
  Json operator()(std::monostate) const { return nullptr; }
  Json operator()(const UtcTime& time) const { return iso_text(time); }
  template <class Value>
  Json operator()(const Value& value) const {
    return value;
  }
};

/// Rounds to that many decimals; never "-0.0".
double rounded(double value, double decimals) {
  const double unit = std::pow(10.0, decimals);
  return std::round(value * unit) / unit + 0.0;
}

Json geometry(const std::optional<GeoPosition>& position) {
  if (!position) return nullptr;
  constexpr double degree_decimals = 7;
  constexpr double metre_decimals = 3;
  Json coordinates = {rounded(position->lon_deg, degree_decimals), rounded(position->lat_deg, degree_decimals)};
  if (std::isfinite(position->alt_m)) coordinates.push_back(rounded(position->alt_m, metre_decimals));
  return {{"type", "Point"}, {"coordinates", coordinates}};
}

/// One feature per line, so that files can be compared with diff. Features are numbered because GDAL would otherwise
/// take the property "id", which is unique within a frame only, for the id of the feature.
template <class Row>
std::string features(std::span<const Row> rows, const std::vector<GeoColumn<Row>>& columns) {
  std::string text = "{\"type\": \"FeatureCollection\", \"features\": [";
  const char* before = "\n";
  std::int64_t id = 0;
  for (const Row& row : rows) {
    Json properties = Json::object();
    for (const GeoColumn<Row>& column : columns) properties[column.name] = std::visit(ToJson{}, column.value(row));
    const Json feature = {
        {"type", "Feature"}, {"id", ++id}, {"geometry", geometry(row.position)}, {"properties", properties}};
    text += before + feature.dump(-1, ' ', false, Json::error_handler_t::replace);
    before = ",\n";
  }
  return text + "\n]}\n";
}

}  // namespace

std::string frames_geojson(std::span<const GeoFrame> frames) {
  return features(frames, geo_frame_columns());
}

std::string damages_geojson(std::span<const GeoDamage> damages) {
  return features(damages, geo_damage_columns());
}

}  // namespace roadstereo::io
