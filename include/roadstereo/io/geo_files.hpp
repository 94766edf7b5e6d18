#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadstereo/damage.hpp"
#include "roadstereo/io/track.hpp"

namespace roadstereo::io {

/// One frame in the GIS files. NaN: unknown.
struct GeoFrame {
  std::int64_t index = 0;                                    ///< in the source, from 0
  std::string name;                                          ///< UTF-8
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< Unix, UTC; a value before 1980 is taken as relative,
                                                             ///< and no time of day is written
  std::optional<GeoPosition> position;
  double roll_rad = std::numeric_limits<double>::quiet_NaN();
  double height_m = std::numeric_limits<double>::quiet_NaN();
  double sigma_d_px = std::numeric_limits<double>::quiet_NaN();
  double valid_share = std::numeric_limits<double>::quiet_NaN();
  int damages = 0;
  std::string status;
};

/// One damage of a frame in the GIS files.
struct GeoDamage {
  std::int64_t frame = 0;  ///< GeoFrame::index
  std::string frame_name;
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< of the frame
  Damage damage;
  std::optional<GeoPosition> position;
};

// RFC 7946: WGS84, longitude before latitude, seven decimals (1 cm), altitude if known. The geometry of a feature
// without a position is null; ids count from 1. Properties are named with their units; unknown values are null.

/// Returns frames.geojson. Properties: frame, name, time_utc (ISO 8601), time_s, status, damages, heading_deg, alt_m,
/// roll_deg, height_m, sigma_d_px, valid_share.
std::string frames_geojson(std::span<const GeoFrame> frames);

/// Returns damages.geojson. Properties: frame, frame_name, time_utc, then the columns of damages.csv.
std::string damages_geojson(std::span<const GeoDamage> damages);

/// Encodes an OGC GeoPackage (EPSG:4326). Layers: `frames` and `damages`, points with the properties of the GeoJSON
/// files as columns, time_utc as DateTime; `track`, one line per segment without a gap, cut at ±180°: start_utc,
/// end_utc, points, length_m. Throws SystemError with GDAL's message on failure; Error if built without GDAL.
std::vector<std::uint8_t> geopackage(std::span<const GeoFrame> frames, std::span<const GeoDamage> damages,
                                     const Track& track);

}  // namespace roadstereo::io
