#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/point_cloud.hpp"

#pragma GCC visibility push(default)
namespace roadstereo::io {

/// Encodes a cloud as binary little-endian PLY: float x y z and, with colours, uchar red green blue. Throws Error if
/// the numbers of points and colours differ.
std::vector<std::uint8_t> encode_ply(const PointCloud& cloud);

}  // namespace roadstereo::io
#pragma GCC visibility pop
