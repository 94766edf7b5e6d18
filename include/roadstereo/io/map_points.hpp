#pragma once

#include <filesystem>

#include "roadstereo/io/geotiff.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Writes the cells of a map as binary little-endian PLY: double x y z in the coordinates of `reference`, metres, float
/// sigma, uchar red green blue. Blocks are read one after another, twice. Throws SystemError if writing fails.
void write_map_points(const std::filesystem::path& file, const MapBox& bounds, const MapReference& reference,
                      const ReadMap& read);

/// Writes the cells of a map as LAS 1.4, point data record format 7: coordinates in steps of 0.1 mm, class 11 (road
/// surface), red, green, blue, and `sigma`, the standard error of z, as an extra float; the coordinate system is in a
/// WKT record. Throws Error for an empty map, for an unknown coordinate system and for points more than 214 km from the
/// map's corner; SystemError if writing fails.
void write_map_las(const std::filesystem::path& file, const MapBox& bounds, const MapReference& reference,
                   const ReadMap& read);

}  // namespace roadstereo::io
#pragma GCC visibility pop
