#pragma once

#include <array>

namespace roadstereo::io {

/// Unit quaternion (x, y, z, w), w ≥ 0, of the rotation of a 3×4 matrix, row-major (Shepperd's method).
std::array<double, 4> quaternion(const std::array<double, 12>& m);

}  // namespace roadstereo::io
