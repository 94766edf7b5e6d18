#pragma once

#include <filesystem>

#include "roadstereo/io/geotiff.hpp"

namespace roadstereo::io {

/// Writes the cells of a map as binary little-endian PLY: double x y z in the coordinates of `reference`, metres, float
/// sigma, uchar red green blue. Blocks are read one after another, twice. Throws SystemError if writing fails.
void write_map_points(const std::filesystem::path& file, const MapBox& bounds, const MapReference& reference,
                      const ReadMap& read);

}  // namespace roadstereo::io
