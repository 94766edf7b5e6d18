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

/// The nearest number with that many decimals, never "-0.0".
double rounded(double value, double decimals) {
  const double unit = std::pow(10.0, decimals);
  return std::round(value * unit) / unit + 0.0;
}

Json geometry(const std::optional<Place>& place) {
  if (!place) return nullptr;
  constexpr double degree_decimals = 7;
  constexpr double metre_decimals = 3;
  Json position = {rounded(place->lon_deg, degree_decimals), rounded(place->lat_deg, degree_decimals)};
  if (std::isfinite(place->alt_m)) position.push_back(rounded(place->alt_m, metre_decimals));
  return {{"type", "Point"}, {"coordinates", position}};
}

/// A feature to the line, so that files of two runs can be compared. Numbered: GDAL takes a property "id", which counts
/// within a frame, for the feature's own unless it has one.
template <class Row>
std::string features(std::span<const Row> rows, const std::vector<GeoColumn<Row>>& columns) {
  std::string text = "{\"type\": \"FeatureCollection\", \"features\": [";
  const char* before = "\n";
  std::int64_t id = 0;
  for (const Row& row : rows) {
    Json properties = Json::object();
    for (const GeoColumn<Row>& column : columns) properties[column.name] = std::visit(ToJson{}, column.value(row));
    const Json feature = {
        {"type", "Feature"}, {"id", ++id}, {"geometry", geometry(row.place)}, {"properties", properties}};
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
