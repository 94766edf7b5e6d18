#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "roadstereo/road_map.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Where a map lies in the world.
struct MapReference {
  double cell_m = 0;  ///< side of a cell
  double east_m = 0;  ///< of the map's origin in `crs`
  double north_m = 0;
  double up_m = 0;  ///< added to heights
  std::string crs;  ///< as GDAL reads it, e.g. "EPSG:32632"; empty: an engineering coordinate system in metres
};

/// Layers of a map as rasters.
enum class MapLayer {
  orthophoto,  ///< red, green, blue and alpha
  height,      ///< metres above z = 0; NaN without a measurement
  sigma,       ///< standard error of the height, metres
  relief,      ///< metres above the smooth reference of the road
  views        ///< number of frames
};

/// Reads cells of a map; `relief` needs `MapRaster::height` relative to the reference.
using ReadMap = std::function<MapRaster(const MapBox& box)>;

/// Writes a layer as Cloud-Optimised GeoTIFF (tiles of 512 pixels, overviews, JPEG for the orthophoto, else DEFLATE).
/// Blocks are read one after another, so that memory does not grow with the map. Throws Error for an empty map, for a
/// coordinate system that GDAL does not know or that is not projected, and if built without GDAL; SystemError with
/// GDAL's message on failure.
void write_geotiff(const std::filesystem::path& file, MapLayer layer, const MapBox& bounds,
                   const MapReference& reference, const ReadMap& read);

}  // namespace roadstereo::io
#pragma GCC visibility pop
