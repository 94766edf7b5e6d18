#pragma once

#include <string>

#include "roadstereo/io/geotiff.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Returns the coordinate system of a map as WKT 1 (OGC 01-009). Throws Error for a name that GDAL does not know.
std::string map_wkt(const MapReference& reference);

}  // namespace roadstereo::io
#pragma GCC visibility pop
