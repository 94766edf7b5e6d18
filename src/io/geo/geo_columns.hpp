#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "io/geo/utc_time.hpp"
#include "roadstereo/io/geo_files.hpp"

namespace roadstereo::io {

/// A property of a feature; monostate: unknown. Numbers are finite.
using GeoValue = std::variant<std::monostate, std::int64_t, double, bool, std::string, UtcTime>;

enum class GeoType { whole, number, flag, text, time };

/// A column of a layer: a property of its features.
template <class Row>
struct GeoColumn {
  std::string name;
  GeoType type = GeoType::text;  ///< of every known value
  std::function<GeoValue(const Row& row)> value;
};

/// Longitude, latitude, degrees, and altitude, metres, NaN unknown: one point, or the corners of a polygon, not closed;
/// empty: no geometry.
using GeoShape = std::vector<std::array<double, 3>>;

/// A layer of the GIS files.
template <class Row>
struct GeoLayer {
  const char* name;
  bool polygons = false;  ///< else points
  std::vector<GeoColumn<Row>> columns;
  GeoShape (*shape)(const Row& row);
};

/// Converts Unix seconds to a time of day; monostate if it is none.
GeoValue geo_time(double time_s);

const GeoLayer<GeoFrame>& frame_layer();
const GeoLayer<GeoFrame>& footprint_layer();
const GeoLayer<GeoSighting>& sighting_layer();
/// The layer `damages`, or `candidates`.
const GeoLayer<RoadDamage>& damage_layer(bool candidates);

/// Number of first columns of `damage_layer` that are those of damages.csv.
inline constexpr std::size_t damage_csv_columns = 14;

/// Returns the rows of a layer of damages.
std::vector<RoadDamage> damage_rows(const GeoLayers& layers, bool candidates);

}  // namespace roadstereo::io
