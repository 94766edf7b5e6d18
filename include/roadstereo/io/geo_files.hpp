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

/// What the map says of a frame. NaN is unknown.
struct GeoFrame {
  std::int64_t index = 0;                                    ///< its place in the source, from 0
  std::string name;                                          ///< UTF-8
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< Unix, UTC; before 1980 it is taken for a time since
                                                             ///< some start, and no time of day is written
  std::optional<Place> place;
  double roll_rad = std::numeric_limits<double>::quiet_NaN();
  double height_m = std::numeric_limits<double>::quiet_NaN();
  double sigma_d_px = std::numeric_limits<double>::quiet_NaN();
  double valid_share = std::numeric_limits<double>::quiet_NaN();
  int damages = 0;
  std::string status;
};

/// A damage of a frame.
struct GeoDamage {
  std::int64_t frame = 0;  ///< GeoFrame::index
  std::string frame_name;
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< of the frame
  Damage damage;
  std::optional<Place> place;
};

// RFC 7946: WGS84, longitude before latitude, seven decimals (a centimetre); the altitude where it is known. A feature
// without a place has the geometry null; its id is its number from 1. Properties are named with their units and null
// where they are not known.

/// Properties: frame, name, time_utc (ISO 8601), time_s, status, damages, heading_deg, alt_m, roll_deg, height_m,
/// sigma_d_px, valid_share.
std::string frames_geojson(std::span<const GeoFrame> frames);

/// Properties: frame, frame_name, time_utc, then the columns of damages.csv.
std::string damages_geojson(std::span<const GeoDamage> damages);

/// An OGC GeoPackage (EPSG:4326) as bytes for OutputFolder::add. Layers: `frames` and `damages`, points with the
/// properties of the GeoJSON files as columns, time_utc as DateTime; `track`, a line for each stretch without a gap,
/// cut at ±180°: start_utc, end_utc, points, length_m. Throws SystemError with GDAL's reason when it cannot be made;
/// Error when the program was built without GDAL.
std::vector<std::uint8_t> geopackage(std::span<const GeoFrame> frames, std::span<const GeoDamage> damages,
                                     const Track& track);

}  // namespace roadstereo::io
