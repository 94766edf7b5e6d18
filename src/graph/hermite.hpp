#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace roadstereo {

/// Tangents of a cubic Hermite spline at its nodes: those of the parabola through three neighbours; at both ends the
/// slope to the neighbour, 0 of a single node. Times increase.
inline std::vector<Eigen::Vector3d> parabola_tangents(const std::vector<double>& times_s,
                                                      const std::vector<Eigen::Vector3d>& positions) {
  const std::size_t count = positions.size();
  const auto slope = [&](std::size_t a, std::size_t b) -> Eigen::Vector3d {
    return (positions[b] - positions[a]) / (times_s[b] - times_s[a]);
  };
  std::vector<Eigen::Vector3d> tangents;
  tangents.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t a = i > 0 ? i - 1 : i, b = std::min(i + 1, count - 1);
    if (a == i || b == i) {
      tangents.push_back(a == b ? Eigen::Vector3d::Zero().eval() : slope(a, b));
      continue;
    }
    const double before = times_s[i] - times_s[a], after = times_s[b] - times_s[i];
    tangents.emplace_back((after * slope(a, i) + before * slope(i, b)) / (before + after));
  }
  return tangents;
}

/// Position on a segment of a cubic Hermite spline at u = 0 … 1. T is double or a jet of Ceres.
template <class T>
Eigen::Matrix<T, 3, 1> hermite(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                               const Eigen::Vector3d& leaving_per_s, const Eigen::Vector3d& arriving_per_s,
                               double length_s, const T& u) {
  const T u2 = u * u, u3 = u2 * u;
  const T start = 2.0 * u3 - 3.0 * u2 + 1.0, end = 3.0 * u2 - 2.0 * u3;
  const T leave = (u3 - 2.0 * u2 + u) * length_s, arrive = (u3 - u2) * length_s;
  Eigen::Matrix<T, 3, 1> position;
  for (Eigen::Index i = 0; i < 3; ++i) {
    position[i] = start * from[i] + end * to[i] + leave * leaving_per_s[i] + arrive * arriving_per_s[i];
  }
  return position;
}

}  // namespace roadstereo
