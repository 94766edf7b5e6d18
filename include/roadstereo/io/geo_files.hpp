#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadstereo/damage.hpp"
#include "roadstereo/io/flight_inventory.hpp"
#include "roadstereo/io/track.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// One frame in the GIS files. NaN: unknown.
struct GeoFrame {
  std::int64_t index = 0;                                    ///< in the source, from 0
  std::string name;                                          ///< UTF-8
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< Unix, UTC; a value before 1980 is taken as relative,
                                                             ///< and no time of day is written
  std::optional<GeoPosition> position;
  double station_m = std::numeric_limits<double>::quiet_NaN();  ///< distance along the positions of the frames
  std::vector<std::array<double, 2>> footprint_deg;  ///< (longitude, latitude) of the road in view; not closed
  double roll_rad = std::numeric_limits<double>::quiet_NaN();
  double height_m = std::numeric_limits<double>::quiet_NaN();
  double sigma_d_px = std::numeric_limits<double>::quiet_NaN();
  double valid_share = std::numeric_limits<double>::quiet_NaN();
  std::optional<std::int64_t> damages;  ///< number of damages; empty: damage could not be searched for
  std::string status;
};

/// One damage of one frame in the GIS files.
struct GeoSighting {
  std::int64_t road_damage = 0;  ///< RoadDamage::id
  std::int64_t frame = 0;        ///< GeoFrame::index
  std::string frame_name;
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< of the frame
  Damage damage;
  std::optional<GeoPosition> position;
};

/// Rows of the GIS files.
struct GeoLayers {
  std::span<const GeoFrame> frames;
  std::span<const GeoSighting> sightings;
  std::span<const RoadDamage> damages;  ///< candidates among them are ignored unless `with_candidates`
  bool with_candidates = false;         ///< adds a layer `candidates`
};

// RFC 7946: WGS84, longitude before latitude, points with seven decimals (1 cm) and the altitude if known, corners of
// polygons with nine. The geometry of a feature without a position is null; ids count from 1. Properties are named with
// their units; unknown values are null.

/// A text file of the results.
struct NamedText {
  std::string name;
  std::string text;
};

/// Returns frames.geojson, footprints.geojson (polygons), sightings.geojson (points), damages.geojson (polygons, one
/// for each damage of the road) and, if asked for, candidates.geojson. Their properties are the columns of the
/// GeoPackage.
std::vector<NamedText> geojson_files(const GeoLayers& layers);

/// Encodes an OGC GeoPackage (EPSG:4326) with the layers of `geojson_files` and a layer `track`: one line per segment
/// without a gap, cut at ±180°, with start_utc, end_utc, points and length_m. time_utc is a DateTime. The table
/// `layer_styles` has a QGIS style by severity for `damages` and `candidates`. Throws SystemError with GDAL's message
/// on failure; Error if built without GDAL.
std::vector<std::uint8_t> geopackage(const GeoLayers& layers, const Track& track);

/// Header line of damages.csv and candidates.csv: id, lat_deg, lon_deg and the eleven columns that are used first.
std::string road_damages_csv_names();
/// One row per damage, in the order given (RFC 4180: CRLF). Unknown values are empty.
std::string road_damages_csv_rows(std::span<const RoadDamage> damages);

}  // namespace roadstereo::io
#pragma GCC visibility pop
