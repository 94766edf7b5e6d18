#pragma once

#include <string>

#include "roadstereo/io/point_cloud.hpp"

namespace roadstereo::io {

/// Reads the vertices of a PLY file: ascii or binary of either byte order, properties in any order and of any type;
/// colours when it has red, green and blue (whole numbers up to the type's largest, floats from 0 to 1). Faces and
/// other elements are passed over, and so are vertices that are not finite. Throws Error naming the file: missing, not
/// PLY, without x, y and z, shorter than its header says, without a finite vertex.
PointCloud read_ply(const std::string& path);

}  // namespace roadstereo::io
