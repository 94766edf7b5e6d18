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

Json position(const std::array<double, 3>& point, double degree_decimals) {
  constexpr double metre_decimals = 3;
  Json coordinates = {rounded(point[0], degree_decimals), rounded(point[1], degree_decimals)};
  if (std::isfinite(point[2])) coordinates.push_back(rounded(point[2], metre_decimals));
  return coordinates;
}

Json geometry(const GeoShape& shape, bool polygon) {
  constexpr double point_decimals = 7, corner_decimals = 9;
  if (shape.empty()) return nullptr;
  if (!polygon) return {{"type", "Point"}, {"coordinates", position(shape.front(), point_decimals)}};
  Json ring = Json::array();
  for (const auto& corner : shape) ring.push_back(position(corner, corner_decimals));
  ring.push_back(ring.front());
  return {{"type", "Polygon"}, {"coordinates", Json::array({ring})}};
}

/// One feature per line, so that files can be compared with diff. Features are numbered because GDAL would otherwise
/// take the property "id" for the id of the feature.
template <class Row>
NamedText features(const GeoLayer<Row>& layer, std::span<const Row> rows) {
  std::string text = "{\"type\": \"FeatureCollection\", \"features\": [";
  const char* before = "\n";
  std::int64_t id = 0;
  for (const Row& row : rows) {
    Json properties = Json::object();
    for (const GeoColumn<Row>& column : layer.columns) {
      properties[column.name] = std::visit(ToJson{}, column.value(row));
    }
    const Json feature = {{"type", "Feature"},
                          {"id", ++id},
                          {"geometry", geometry(layer.shape(row), layer.polygons)},
                          {"properties", properties}};
    text += before + feature.dump(-1, ' ', false, Json::error_handler_t::replace);
    before = ",\n";
  }
  return {std::string(layer.name) + ".geojson", text + "\n]}\n"};
}

}  // namespace

std::vector<NamedText> geojson_files(const GeoLayers& layers) {
  const std::vector<RoadDamage> damages = damage_rows(layers, false);
  std::vector<NamedText> files = {features(frame_layer(), layers.frames), features(footprint_layer(), layers.frames),
                                  features(sighting_layer(), layers.sightings),
                                  features(damage_layer(false), std::span<const RoadDamage>(damages))};
  if (layers.with_candidates) {
    const std::vector<RoadDamage> candidates = damage_rows(layers, true);
    files.push_back(features(damage_layer(true), std::span<const RoadDamage>(candidates)));
  }
  return files;
}

}  // namespace roadstereo::io
