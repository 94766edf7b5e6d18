#include "io/quaternion.hpp"

#include <algorithm>
#include <cmath>

namespace roadstereo::io {

std::array<double, 4> quaternion(const std::array<double, 12>& m) {
  const double trace = m[0] + m[5] + m[10];
  const std::array<double, 4> squares{m[0] - m[5] - m[10], m[5] - m[0] - m[10], m[10] - m[0] - m[5], trace};
  const auto largest = static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
  const double root = std::sqrt(1 + squares[largest]);
  const double x = m[9] - m[6], y = m[2] - m[8], z = m[4] - m[1];
  const double xy = m[1] + m[4], xz = m[2] + m[8], yz = m[6] + m[9];
  std::array<double, 4> q{};
  switch (largest) {
    case 0:
      q = {root * root, xy, xz, x};
      break;
    case 1:
      q = {xy, root * root, yz, y};
      break;
    case 2:
      q = {xz, yz, root * root, z};
      break;
    default:
      q = {x, y, z, root * root};
  }
  const double scale = (q[3] < 0 ? -0.5 : 0.5) / root;
  for (double& value : q) value *= scale;
  return q;
}

}  // namespace roadstereo::io
