#pragma once

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

/// Converts Unix seconds to a time of day; monostate if it is none.
GeoValue geo_time(double time_s);

const std::vector<GeoColumn<GeoFrame>>& geo_frame_columns();
const std::vector<GeoColumn<GeoDamage>>& geo_damage_columns();

}  // namespace roadstereo::io
