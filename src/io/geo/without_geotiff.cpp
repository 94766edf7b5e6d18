// Replacement for builds without GDAL.

#include "io/geo/map_crs.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/io/geotiff.hpp"

namespace roadstereo::io {

void write_geotiff(const std::filesystem::path& file, MapLayer /*layer*/, const MapBox& /*bounds*/,
                   const MapReference& /*reference*/, const ReadMap& /*read*/) {
  fail(file.string(),
       ": this build does not write GeoTIFF; it needs the package libgdal-dev and CMake's "
       "-DROADSTEREO_GEO=ON");
}

std::string map_wkt(const MapReference& /*reference*/) {
  fail(
      "this build does not write LAS; it needs the package libgdal-dev and CMake's "
      "-DROADSTEREO_GEO=ON");
}

}  // namespace roadstereo::io
